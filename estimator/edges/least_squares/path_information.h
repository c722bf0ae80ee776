#pragma once

#include <Eigen/Core>

namespace saccade {

/// What some edges of a bundle say of its path, whatever they themselves are: the quadratic
///   1/2 x^T H x + g^T x
/// of a change x of all twists from where the unknowns are now, J with the weights of the losses.
struct PathInformation {
  Eigen::MatrixXd information;  ///< H, symmetric, positive semidefinite
  Eigen::VectorXd gradient;     ///< g
};

}  // namespace saccade
