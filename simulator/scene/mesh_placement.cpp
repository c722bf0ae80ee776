#include "simulator/scene/mesh_placement.h"

namespace saccade {
namespace {

Eigen::AlignedBox3d bounding_box(const Mesh& mesh, const Eigen::Matrix3d& linear) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(linear * vertex);
  return box;
}

Eigen::Vector3d scale_to_size(const Eigen::Vector3d& size, const Mesh& mesh) {
  const Eigen::Vector3d extent = bounding_box(mesh, Eigen::Matrix3d::Identity()).sizes();
  return (extent.array() > 0).select(size.cwiseQuotient(extent), Eigen::Vector3d::Ones());
}

Eigen::Vector3d anchor_point(Anchor anchor, const Eigen::AlignedBox3d& box) {
  if (anchor == Anchor::kOrigin) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d center = box.center();
  return anchor == Anchor::kCenter ? center
                                   : Eigen::Vector3d(center.x(), center.y(), box.min().z());
}

/// Turns +y to +z.
Eigen::Matrix3d z_from_y() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

}  // namespace

Eigen::Affine3d world_from_mesh(const MeshOptions& options, const Mesh& mesh) {
  const Eigen::Vector3d scale =
      options.size_m ? scale_to_size(*options.size_m, mesh) : options.transform.scale;
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  Eigen::Matrix3d rotation = rotation_of(options.transform.rotation_deg);
  if (options.up == UpAxis::kY) rotation *= z_from_y();
  transform.linear() = rotation * scale.asDiagonal();
  transform.translation() = options.transform.translation -
                            anchor_point(options.anchor, bounding_box(mesh, transform.linear()));
  return transform;
}

}  // namespace saccade
