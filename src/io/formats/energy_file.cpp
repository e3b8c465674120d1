#include "io/formats/energy_file.hpp"

#include "base/numbers.hpp"

#include <array>
#include <fstream>

namespace spring_pendulum {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;
constexpr const char* kHeader =
    "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],residual [J],"
    "residual/scale [1],position error [m]\n";

}  // namespace

EnergyFile::EnergyFile(const std::string& path, std::int64_t first) : file_(path), text_(kHeader) {
  std::ifstream earlier(first > 0 ? path : "");
  for (std::string row; std::getline(earlier, row);) {
    if (parseInteger(row.substr(0, row.find(','))).value_or(first) < first) text_ += row + '\n';
  }
}

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
