// The tableaus for which kernels for whole steps are compiled. Any other tableau runs stage by
// stage, more slowly but with the same bits.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>

namespace spring_pendulum {

inline constexpr const ButcherTableau* kFastTableaus[] = {
    &kEulerTableau,
    &kMidpointTableau,
    &kClassicalRungeKuttaTableau,
};

}  // namespace spring_pendulum
