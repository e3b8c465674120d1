# Warnings for our own code, and the flags that make results the same bits on every machine: no
# fast-math, and no contraction: multiply-adds are fused only where the code calls `fused`. The two
# -fno flags take away errno and traps, which nobody reads and which keep the compiler from
# vectorising; no result changes.
add_library(spring_pendulum_options INTERFACE)
target_compile_options(spring_pendulum_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off -fno-math-errno
  -fno-trapping-math)
if(SPRING_PENDULUM_SANITIZE)
  add_compile_options(-fsanitize=${SPRING_PENDULUM_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SPRING_PENDULUM_SANITIZE})
endif()
