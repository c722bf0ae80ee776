#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/io/tables/h5_file.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// The rigid transformation of 16 numbers, row by row; InputError(location) where its rotation is none.
[[nodiscard]] Rigid3 rigid_of(const double* rows, const std::string& location);

/// N x 4 x 4 matrices and as many times, times `unit_s`; those that are not finite or do not increase
/// are left out, of the matrices the inverse where `inverted`.
[[nodiscard]] std::vector<StampedPose> read_h5_poses(const H5File& file,
                                                     const std::string& matrices,
                                                     const std::string& times, double unit_s,
                                                     bool inverted);

/// Increasing times, times `unit_s`.
[[nodiscard]] std::vector<double> read_h5_times(const H5File& file, const std::string& path,
                                                double unit_s);

/// N x height x width images: that of the index, whose size must be this. Depth that is not finite or
/// not positive is 0.
[[nodiscard]] ImageF read_h5_depth(const H5File& file, const std::string& path, std::size_t index,
                                   int width, int height);
[[nodiscard]] ImageU8 read_h5_grey(const H5File& file, const std::string& path, std::size_t index,
                                   int width, int height);

}  // namespace saccade
