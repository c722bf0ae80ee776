#include "simulator/sensor/noise/noise_models.h"

#include <algorithm>

#include "core/config/fields.h"

namespace saccade {
namespace {

template <auto kMember>
void describe_member(config::Fields& fields, NoiseOptions& options) {
  describe(fields, options.*kMember);
}

template <auto kMember>
bool is_member_on(const NoiseOptions& options) {
  return (options.*kMember).on();
}

template <auto kMember, auto kApply>
void apply(const NoiseOptions& options, std::uint64_t seed, PixelTraits& traits) {
  kApply(options.*kMember, seed, traits);
}

std::unique_ptr<OutputStage> make_delay(const OutputStageInput& input) {
  return std::make_unique<EventDelay>(input.noise.latency, input.width, input.height, input.unit_ns,
                                      input.seed);
}

std::unique_ptr<OutputStage> make_bus(const OutputStageInput& input) {
  return std::make_unique<EventBus>(input.noise.readout, input.height, input.unit_ns);
}

constexpr NoiseModel kModels[] = {
    {.name = "mismatch",
     .help = "Contrast thresholds that differ from pixel to pixel.",
     .describe = describe_member<&NoiseOptions::mismatch>,
     .is_on = is_member_on<&NoiseOptions::mismatch>,
     .shape_pixel = apply<&NoiseOptions::mismatch, apply_mismatch>,
     .make_stage = nullptr},
    {.name = "refractory",
     .help = "Time after an event in which a pixel cannot fire.",
     .describe = describe_member<&NoiseOptions::refractory>,
     .is_on = is_member_on<&NoiseOptions::refractory>,
     .shape_pixel = nullptr,
     .make_stage = nullptr},
    {.name = "leak",
     .help = "A reference that falls with time, so that a static scene causes ON events.",
     .describe = describe_member<&NoiseOptions::leak>,
     .is_on = is_member_on<&NoiseOptions::leak>,
     .shape_pixel = apply<&NoiseOptions::leak, apply_leak>,
     .make_stage = nullptr},
    {.name = "shot",
     .help = "Shot noise, whose rate falls with the radiance.",
     .describe = describe_member<&NoiseOptions::shot>,
     .is_on = is_member_on<&NoiseOptions::shot>,
     .shape_pixel = nullptr,
     .make_stage = nullptr},
    {.name = "bandwidth",
     .help = "Low pass of the photoreceptor, whose cutoff grows with the radiance.",
     .describe = describe_member<&NoiseOptions::bandwidth>,
     .is_on = is_member_on<&NoiseOptions::bandwidth>,
     .shape_pixel = nullptr,
     .make_stage = nullptr},
    {.name = "hot",
     .help = "Hot pixels, which fire ON events without any signal.",
     .describe = describe_member<&NoiseOptions::hot>,
     .is_on = is_member_on<&NoiseOptions::hot>,
     .shape_pixel = nullptr,
     .make_stage = nullptr},
    {.name = "latency",
     .help = "Delay and jitter of the time stamps.",
     .describe = describe_member<&NoiseOptions::latency>,
     .is_on = is_member_on<&NoiseOptions::latency>,
     .shape_pixel = nullptr,
     .make_stage = make_delay},
    {.name = "readout",
     .help = "Bus with a finite rate, at which events wait or are lost.",
     .describe = describe_member<&NoiseOptions::readout>,
     .is_on = is_member_on<&NoiseOptions::readout>,
     .shape_pixel = nullptr,
     .make_stage = make_bus},
};

}  // namespace

std::span<const NoiseModel> noise_models() { return kModels; }

bool NoiseOptions::any() const {
  return std::ranges::any_of(kModels, [this](const NoiseModel& m) { return m.is_on(*this); });
}

void describe(config::Fields& fields, NoiseOptions& options) {
  for (const NoiseModel& model : kModels)
    fields.group(
        model.name, [&](config::Fields& section) { model.describe(section, options); }, model.help);
}

}  // namespace saccade
