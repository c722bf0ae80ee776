#include "simulator/scene/light/light_options.h"

#include <Eigen/Geometry>

namespace saccade {
namespace {

constexpr double kMostSamples = 8;

void describe_area(config::Fields& fields, LightOptions& options) {
  if (options.type == LightType::kRectangle) {
    fields.value("size_m", options.size_m, "Width and height of the rectangle, in metres.")
        .range(1e-4, 1e4);
    fields
        .value("width_direction", options.width_direction,
               "Direction of the rectangle's width, which is made perpendicular to 'direction'; "
               "zero: the level one, or +x of a rectangle that is level itself.")
        .range(-1e6, 1e6);
    fields.expect(options.width_direction.isZero() ||
                      options.width_direction.cross(options.direction).norm() >
                          1e-6 * options.width_direction.norm() * options.direction.norm(),
                  "width_direction", "must not be parallel to 'direction'");
  } else {
    fields.value("radius_m", options.radius_m, "Radius of the disc, in metres.").range(1e-4, 1e4);
  }
  fields
      .value(
          "samples_per_side", options.samples_per_side,
          "Point emitters along each side of the area: n for n x n that stand for the light. Its "
          "half-shadows fall off in so many steps, and light nearby is the more exact; each "
          "costs as much as a point light. All lights of a scene are 64 at most, each emitter "
          "counted.")
      .range(1, kMostSamples);
}

}  // namespace

void describe(config::Fields& fields, LightOptions& options) {
  fields.choice("type", options.type,
                {{"point", LightType::kPoint},
                 {"directional", LightType::kDirectional},
                 {"spot", LightType::kSpot},
                 {"rectangle", LightType::kRectangle},
                 {"disc", LightType::kDisc}},
                "Kind of light: point shines from its position to all sides, spot from there into "
                "a cone, and directional comes from afar in parallel. A rectangle or a disc shines "
                "from one of its faces and casts soft shadows.");
  if (options.has_position())
    fields
        .value("position", options.position,
               "Position of the light, of an area light that of its centre, in metres.")
        .range(-1e6, 1e6)
        .required();
  if (options.type != LightType::kPoint) {
    fields
        .value(
            "direction", options.direction,
            "Direction in which the light travels; of a spot, the axis of its cone, of a rectangle "
            "or a disc the normal of the face that shines.")
        .range(-1e6, 1e6)
        .required();
    fields.expect(options.direction.norm() > 0, "direction", "must not be zero");
  }
  if (options.type == LightType::kSpot) {
    fields
        .value("inner_angle_deg", options.inner_angle_deg,
               "Angle from the axis up to which a spot has its full intensity, in degrees.")
        .range(0, 90);
    fields
        .value("outer_angle_deg", options.outer_angle_deg,
               "Angle from the axis beyond which a spot gives no light, in degrees. Between both "
               "angles the intensity falls off smoothly.")
        .above(0)
        .at_most(90);
    fields.expect(options.outer_angle_deg - options.inner_angle_deg >= kLeastFalloff_deg,
                  "outer_angle_deg", "must be above inner_angle_deg by at least 0.01");
  }
  if (options.is_area()) describe_area(fields, options);
  fields
      .value("intensity", options.intensity,
             "Radiance of a white surface that faces the light, at a distance of 1 m from a point "
             "light or, on its axis, from a spot. Of an area light, as if all of it shone from its "
             "centre.")
      .at_least(0);
  fields.value("shadows", options.shadows, "Whether meshes cast shadows in this light.");
  fields.section("flicker", options.flicker,
                 "Flicker of the light, whose mean over a period is its intensity.");
}

}  // namespace saccade
