// The hash by which a journal knows its study, and its lines.
#pragma once

#include <cstdint>
#include <string_view>

namespace spring_pendulum::sweep {

/// Returns the hash FNV-1a of a text that continues a text with the hash `hash` (RFC 9923).
inline std::uint64_t hashOf(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace spring_pendulum::sweep
