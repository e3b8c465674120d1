// What the shared library exports: everything that a public header declares, and nothing else.
#pragma once

/// Marks a block of the namespace whose functions and classes other programs may use.
#define SPRING_PENDULUM_API [[gnu::visibility("default")]]
