#include "integration/kernels/chain_kernels.hpp"

#include "integration/kernels/kernel_data.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace spring_pendulum {
namespace {

bool isSame(const ButcherTableau& p, const ButcherTableau& q) {
  return p.stages == q.stages && p.a == q.a && p.b == q.b;
}

std::vector<const ChainKernels*> findSupportedKernels() {
  std::vector<const ChainKernels*> found;
#ifdef SPRING_PENDULUM_X86_KERNELS
  __builtin_cpu_init();
  const bool avx2 = static_cast<bool>(__builtin_cpu_supports("avx2")) &&
                    static_cast<bool>(__builtin_cpu_supports("fma"));
  const bool avx512 = avx2 && static_cast<bool>(__builtin_cpu_supports("avx512f")) &&
                      static_cast<bool>(__builtin_cpu_supports("avx512dq")) &&
                      static_cast<bool>(__builtin_cpu_supports("avx512vl"));
  if (avx512) found.push_back(&kAvx512Kernels);
  if (avx2) found.push_back(&kAvx2Kernels);
#endif
  found.push_back(&kBaselineKernels);
  return found;
}

}  // namespace

const std::vector<const ChainKernels*>& supportedChainKernels() {
  static const std::vector<const ChainKernels*> kSupported = [] {
    const char* name = std::getenv("SPRING_PENDULUM_INSTRUCTION_SET");
    return name == nullptr ? findSupportedKernels() : chainKernelsUpTo(name);
  }();
  return kSupported;
}

std::vector<const ChainKernels*> chainKernelsUpTo(std::string_view name) {
  std::vector<const ChainKernels*> kernels = findSupportedKernels();
  const auto named = std::find_if(kernels.begin(), kernels.end(),
                                  [name](const ChainKernels* k) { return k->name == name; });
  if (named != kernels.end()) return {named, kernels.end()};
  std::string known;
  for (const ChainKernels* k : kernels) known.append(known.empty() ? "" : ", ").append(k->name);
  throw InputError(
      fmt::format("SPRING_PENDULUM_INSTRUCTION_SET must be one of {} on this processor, got '{}'",
                  known, name));
}

AdvanceKernel findAdvanceKernel(const ChainKernels& kernels, const ButcherTableau& tableau,
                                StepNeeds needs) {
  std::size_t index = 0;
  for (const ButcherTableau* fast : kFastTableaus) {
    if (isSame(*fast, tableau)) return kernels.advanceKernel(index, needs);
    ++index;
  }
  return nullptr;
}

KernelConstants::KernelConstants(const Chain& chain) {
  chain_.spring = chain.spring();
  chain_.gravity = chain.isDriven() ? 0.0 : chain.gravity();
  chain_.size = chain.size();
  chain_.pitch = StateBuffer::pitchFor(chain.size());
  inverse_masses_ = AlignedNumbers(kFirstMoving + chain_.pitch);
  double* const inverse_masses = inverse_masses_.data() + kFirstMoving;
  std::copy_n(chain.inverseMasses().data() + 1, chain.size() - 1, inverse_masses);
  chain_.inverse_masses = inverse_masses;
  if (chain.isDriven()) {
    drive_ = AlignedNumbers(2 * chain_.pitch);
    chain_.drive = drive_.data();
    chain_.anchor[0] = chain.springlessAcceleration(0).x;
    chain_.anchor[1] = chain.springlessAcceleration(0).y;
    for (std::ptrdiff_t i = 1; i < chain.size(); ++i) {
      const PlaneVector<double> acceleration = chain.springlessAcceleration(i);
      drive_[i - 1] = acceleration.x;
      drive_[chain_.pitch + i - 1] = acceleration.y;
    }
  }
  if (chain.airDrag() == 0.0) return;
  drag_rates_ = AlignedNumbers(chain_.pitch);
  chain_.drag_rates = drag_rates_.data();
  drag_rates_.view().head(chain.size() - 1) =
      chain.airDrag() * chain.inverseMasses().tail(chain.size() - 1);
}

}  // namespace spring_pendulum
