// Random scenes by number, the same on every machine. Consecutive ones belong to different families.
#pragma once

#include "support/scene.hpp"

namespace spring_pendulum::test {

/// Scene `seed` belongs to family `seed` modulo their number; its name is "light tail 17".
/// Particles: 2 to 12, in long families 13 to 60; masses down to 1e-9 kg, stiffness up to 1e9 N/m.
Scene randomScene(unsigned seed);

}  // namespace spring_pendulum::test
