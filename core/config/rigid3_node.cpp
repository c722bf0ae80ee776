#include "core/config/rigid3_node.h"

#include <array>

#include "core/config/convert.h"
#include "core/config/source_location.h"

namespace saccade {
namespace {

using Rows = std::array<std::array<double, 4>, 4>;

}  // namespace

void from_node(const config::Node& node, const std::string& name, Rigid3& value) {
  constexpr double kTolerance = 1e-3;
  Rows rows{};
  config::from_node(node, name, rows);
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    r.row(i) << row[0], row[1], row[2];
  }
  const bool rotates =
      (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() < kTolerance && r.determinant() > 0;
  if (!rotates || rows[3] != std::array<double, 4>{0, 0, 0, 1})
    throw config::error_at(
        node.location, name, " ",
        "is no rigid transformation: a rotation, a translation, and 0 0 0 1 below");
  value = {Eigen::Quaterniond(r), {rows[0][3], rows[1][3], rows[2][3]}};
}

config::Node to_node(const Rigid3& value) {
  const Eigen::Matrix3d r = value.rotation_matrix();
  const Eigen::Vector3d& t = value.translation();
  Rows rows{};
  for (int i = 0; i < 3; ++i) rows[static_cast<std::size_t>(i)] = {r(i, 0), r(i, 1), r(i, 2), t[i]};
  rows[3] = {0, 0, 0, 1};
  return config::to_node(rows);
}

}  // namespace saccade
