// A checksum of text: FNV-1a with 64 bits (G. Fowler, L. C. Noll, K.-P. Vo; RFC 9923).
#pragma once

#include <cstdint>
#include <string_view>

namespace spring_pendulum::sweep {

inline constexpr std::uint64_t kHashStart = 0xcbf29ce484222325;

/// Returns the hash of a text that continues a text with the hash `hash`.
inline std::uint64_t hashOf(std::string_view text, std::uint64_t hash = kHashStart) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace spring_pendulum::sweep
