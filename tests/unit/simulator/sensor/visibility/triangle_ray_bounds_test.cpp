#include "simulator/sensor/visibility/triangle_ray_bounds.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

/// A triangle turned to the ray (0, 0, 1), far inside two of its edges and with `forms` of the
/// third.
TransitTriangle with_edge(const std::array<double, 3>& forms) {
  TransitTriangle triangle{0, {}};
  for (std::size_t m = 0; m < forms.size(); ++m)
    triangle.at[m] = {
        {Eigen::Vector3d(0.1, 0, forms[m]), {0, 0.1, 1}, {0.1, 0.1, 1}}, {0, 0, 1}, 1};
  return triangle;
}

// Where the parabola through the three forms is zero: -1.2 + 3.2 u at first, bent both ways then.
TEST(TriangleRayBounds, KnowWhenARayCrossesAnEdge) {
  const Eigen::Vector3d ray(0, 0, 1);
  for (const double sign : {1.0, -1.0})
    for (const double bend : {-1.5, 0.0, 1e-12, 1.5}) {
      const auto form = [&](double u) { return sign * (-1.2 + 3.2 * u + bend * u * (u - 1)); };
      const TransitTriangle triangle = with_edge({form(0), form(0.5), form(1)});
      const TriangleRayBounds bounds(triangle, ray, 1e-3);
      ASSERT_EQ(bounds.edge_crossed(sign > 0), std::optional<std::size_t>(0)) << bend;
      EXPECT_GT(bounds.crossing(0), 0);
      EXPECT_LT(bounds.crossing(0), 1);
      EXPECT_NEAR(form(bounds.crossing(0)), 0, 1e-12) << bend;
    }
}

}  // namespace
}  // namespace saccade
