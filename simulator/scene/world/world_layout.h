#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/motion/motion_options.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/scene_options.h"
#include "simulator/scene/world/sheet_cutter.h"
#include "simulator/scene/world/world_dice.h"

namespace saccade {

/// The box that closes a world all around, in its own axes: distances of its walls from the origin.
struct WorldShell {
  double front = 6, back = 2, left = 5, right = 5, down = 1.4, up = 2;  ///< [m], along +y, -y ...
  double turn = 0;  ///< slope by which it is turned about z
};

/// One object of a world that is generated, not read from a file.
struct WorldPart {
  std::string name;
  Mesh mesh;  ///< whose triangles name the world's textures as materials
  Eigen::Isometry3d world_from_mesh = Eigen::Isometry3d::Identity();
  std::optional<MotionOptions> trajectory;
};

/// A world while it is built: what is in it, and where there is room for more.
class WorldLayout {
 public:
  WorldLayout(std::uint64_t seed, SheetCutter& cutter);

  [[nodiscard]] SheetCutter& cutter() { return cutter_; }
  [[nodiscard]] WorldDice dice(std::uint64_t stream) const { return {seed_, stream}; }

  /// Closes the world with walls of panels. To be called once.
  void close(const WorldShell& shell);
  [[nodiscard]] const WorldShell& shell() const { return shell_; }
  [[nodiscard]] const Eigen::Isometry3d& world_from_shell() const { return world_from_shell_; }

  /// Keeps everything that is added later out of a ball, as the ball around the origin.
  void keep_out(const Eigen::Vector3d& centre, double radius) { free_.push_back({centre, radius}); }
  /// Whether a ball, or a box in axes of its own, touches no free ball.
  [[nodiscard]] bool is_clear(const Eigen::Vector3d& centre, double radius) const;
  [[nodiscard]] bool is_clear(const Eigen::AlignedBox3d& box,
                              const Eigen::Isometry3d& world_from_box) const;
  /// The same for a mesh by its vertices, which lie densely.
  [[nodiscard]] bool is_clear(const Mesh& mesh, const Eigen::Isometry3d& world_from_mesh) const;
  /// Whether a ball lies within the walls.
  [[nodiscard]] bool is_inside(const Eigen::Vector3d& centre, double radius) const;
  /// Takes the room of a ball, unless some of it is taken.
  [[nodiscard]] bool take(const Eigen::Vector3d& centre, double radius);

  void add(std::string name, Mesh mesh, const Eigen::Isometry3d& world_from_mesh);
  void add_moving(std::string name, Mesh mesh, MotionOptions trajectory);
  void add_file(MeshOptions mesh) { files_.push_back(std::move(mesh)); }

  [[nodiscard]] std::vector<WorldPart>& parts() { return parts_; }
  [[nodiscard]] std::vector<MeshOptions>& files() { return files_; }

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
  };
  void add_wall(const char* name, const Eigen::Vector3d& corner, const Eigen::Vector3d& along,
                const Eigen::Vector3d& up, WorldDice& dice);

  std::uint64_t seed_;
  SheetCutter& cutter_;
  WorldShell shell_;
  Eigen::Isometry3d world_from_shell_ = Eigen::Isometry3d::Identity();
  std::vector<Ball> free_, taken_;
  std::vector<WorldPart> parts_;
  std::vector<MeshOptions> files_;
};

/// A pose from its parts.
[[nodiscard]] Eigen::Isometry3d placed_at(const Eigen::Vector3d& position,
                                          const Eigen::Matrix3d& rotation);

}  // namespace saccade
