#include <array>
#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_shapes.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kMovingStream = 2300;

/// Two metres before the camera a ball of this radius takes 6 % of a view of 50 by 38 degrees; 10 %
/// from half a metre nearer.
constexpr double kObjectRadius_m = 0.22;
constexpr double kObjectDistance_m = 2.05;
/// The largest amplitudes of its motion.
const Vector3d kAmplitude_m(0.35, 0.12, 0.25);
/// Longer than any recording of a world; then it rests.
constexpr double kMotion_s = 20;

MotionOptions draw_object_motion(WorldDice& dice, const Vector3d& centre) {
  MotionOptions motion;
  motion.source = MotionSource::kLissajous;
  motion.duration_s = kMotion_s;
  motion.lissajous.centre = centre;
  Oscillation& position = motion.lissajous.position;
  position.amplitude = dice.vector(0.5 * kAmplitude_m, kAmplitude_m);
  position.frequency_hz = dice.vector({0.3, 0.3, 0.3}, {0.9, 0.9, 0.9});
  position.phase_deg = dice.vector({0, 0, 0}, {360, 360, 360});
  Oscillation& rotation = motion.lissajous.rotation;
  rotation.amplitude = dice.vector({10, 10, 10}, {60, 60, 60});
  rotation.frequency_hz = dice.vector({0.2, 0.2, 0.2}, {0.7, 0.7, 0.7});
  rotation.phase_deg = dice.vector({0, 0, 0}, {360, 360, 360});
  return motion;
}

}  // namespace

void build_moving(WorldLayout& layout) {
  constexpr std::array kStill{build_room,      build_corridor, build_layers, build_clutter,
                              build_furniture, build_relief,   build_thin};
  WorldDice dice = layout.dice(kMovingStream);
  const Vector3d centre =
      dice.vector({-0.25, kObjectDistance_m, -0.1}, {0.25, kObjectDistance_m, 0.15});
  layout.keep_out(centre, kAmplitude_m.norm() + kObjectRadius_m);
  const auto build =
      kStill[static_cast<std::size_t>(dice.integer(0, static_cast<int>(kStill.size()) - 1))];
  build(layout);
  Mesh object = draw_solid(dice, dice.between(0.7, 1) * kObjectRadius_m, layout.cutter());
  layout.add_moving("moving object", std::move(object), draw_object_motion(dice, centre));
}

}  // namespace saccade
