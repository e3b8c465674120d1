// The tableaus that are compiled into the kernels. One line here makes a tableau fast; any other
// runs stage by stage, with the same bits.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>

namespace spring_pendulum {

inline constexpr const ButcherTableau* kFastTableaus[] = {
    &kEulerTableau,
    &kMidpointTableau,
    &kClassicalRungeKuttaTableau,
};

}  // namespace spring_pendulum
