#include "io/formats/energy_file.hpp"

#include "base/numbers.hpp"

#include <array>

namespace spring_pendulum {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;
constexpr const char* kHeader =
    "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],residual [J],"
    "residual/scale [1],position error [m]\n";

}  // namespace

EnergyFile::EnergyFile(const std::string& path) : file_(path), text_(kHeader) {}

void EnergyFile::write(std::int64_t frame, const EnergyEntry& entry, double position_error) {
  text_ += std::to_string(frame);
  std::array<char, kLongestNumber> number;
  for (const double value :
       {entry.time, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
        entry.energy.total(), entry.dissipated.value(), entry.residual.value(),
        entry.relative_residual.value(), position_error}) {
    text_ += ',';
    text_.append(number.data(), writeNumber(value, number.data()));
  }
  text_ += '\n';
  if (text_.size() < kBufferSize) return;
  file_.write(text_);
  text_.clear();
}

void EnergyFile::finish() {
  file_.write(text_);
  file_.finish();
}

}  // namespace spring_pendulum
