#include "simulator/scene/light/light_options.h"

namespace saccade {

void describe(config::Fields& fields, LightOptions& options) {
  fields.choice("type", options.type,
                {{"point", LightType::kPoint},
                 {"directional", LightType::kDirectional},
                 {"spot", LightType::kSpot}},
                "Kind of light: point shines from its position to all sides, spot from there into "
                "a cone, and directional comes from afar in parallel.");
  if (options.has_position())
    fields.value("position", options.position, "Position of the light, in metres.")
        .range(-1e6, 1e6)
        .required();
  if (options.type != LightType::kPoint) {
    fields
        .value("direction", options.direction,
               "Direction in which the light travels; of a spot, the axis of its cone.")
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
  fields
      .value("intensity", options.intensity,
             "Radiance of a white surface that faces the light, at a distance of 1 m from a point "
             "light or, on its axis, from a spot.")
      .at_least(0);
  fields.value("shadows", options.shadows, "Whether meshes cast shadows in this light.");
  fields.section("flicker", options.flicker,
                 "Flicker of the light, whose mean over a period is its intensity.");
}

}  // namespace saccade
