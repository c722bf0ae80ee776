#include "simulator/scene/light/occluder_lanes.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

/// One number after another.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return random_.uniform(0, index_++); }

 private:
  Random random_;
  std::uint64_t index_ = 0;
};

Eigen::Vector3d random_vector(Draws& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

TEST(OccluderLanes, KeepsAllThatMayHideAndLittleElse) {
  Draws random(5);
  const Eigen::Vector3d origin(30, -20, 7);  // far from the world's: rounding there is coarse
  std::vector<OccluderLanes::Forms> occluders(300);
  OccluderLanes lanes(origin, 1);
  for (auto& forms : occluders) {
    for (AffineForm& form : forms) {
      form.gradient = random_vector(random);
      form.offset = -form.gradient.dot(origin + random_vector(random));
    }
    lanes.add(forms);
  }
  std::size_t hidden = 0;
  std::size_t kept = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d from = origin + random_vector(random);
    const Eigen::Vector3d step = 0.01 * random_vector(random);
    const OccluderLanes::Points points{from, from + step, from + 2 * step};
    std::vector<bool> is_kept(occluders.size());
    lanes.visit_candidates(points, [&](std::size_t k) {
      is_kept[k] = true;
      ++kept;
      return true;
    });
    for (std::size_t k = 0; k < occluders.size(); ++k)
      for (const Eigen::Vector3d& point : points) {
        bool hides = true;
        for (const AffineForm& form : occluders[k]) hides = hides && form.at(point) > 0;
        hidden += hides ? 1 : 0;
        EXPECT_TRUE(!hides || is_kept[k]);
      }
  }
  EXPECT_GT(hidden, 1000U);
  EXPECT_LT(kept, hidden);  // which counts three points of each points
}

TEST(OccluderLanes, StopsWhenTold) {
  OccluderLanes lanes(Eigen::Vector3d::Zero(), 1);
  const AffineForm above{Eigen::Vector3d::Zero(), 1};
  for (int i = 0; i < 20; ++i) lanes.add({above, above, above, above});
  int visits = 0;
  const Eigen::Vector3d point = Eigen::Vector3d::Zero();
  lanes.visit_candidates({point, point, point}, [&](std::size_t) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

}  // namespace
}  // namespace saccade
