#include <cstdio>

#include "core/rigid3.h"
#include "core/version.h"
#include "estimator/registry.h"

int main() {
  // Eigen members cross the boundary to a library that may have been built with -march=native.
  saccade::Twist twist;
  twist << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  const double error = (saccade::Rigid3::exp(twist).log() - twist).norm();
  std::printf("saccade %s: |log(exp(xi)) - xi| = %.1e\n", saccade::version().data(), error);
  for (const saccade::Module& module : saccade::modules()) std::puts(module.name);
  return error < 1e-12 && !saccade::modules().empty() ? 0 : 1;
}
