// Visibility: the shared library exports what public headers declare, and nothing else.
#pragma once

/// Marks a namespace block whose functions and classes the shared library exports.
#define SPRING_PENDULUM_API [[gnu::visibility("default")]]
