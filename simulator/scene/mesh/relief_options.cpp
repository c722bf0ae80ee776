#include "simulator/scene/mesh/relief_options.h"

#include <algorithm>

#include "core/config/config.h"

namespace saccade {
namespace {

constexpr double kMostTriangles = 4e6;
constexpr double kMostWaves = 2048;

}  // namespace

void describe(config::Fields& fields, ReliefOptions& options) {
  fields.value("size_m", options.size_m, "along x and y").above(0);
  fields.value("triangles", options.triangles, "about how many").range(2, kMostTriangles);
  fields.value("seed", options.seed, "another relief of the same kind");
  fields.path("texture", options.texture, "picture or *.texture.yaml over the whole").must_exist();
  fields.value("albedo", options.albedo, "without a texture; linear light").range(0, 1);
  const double side = std::max(options.size_m[0], options.size_m[1]);
  const auto expect_few_waves = [side](config::Fields& group, std::string_view key,
                                       double wavelength) {
    group.expect(side / wavelength <= kMostWaves, key, "must fit at most 2048 times into size_m");
  };
  fields.group(
      "dunes",
      [&](config::Fields& group) {
        auto& dunes = options.dunes;
        group.value("height_m", dunes.height_m, "of the highest crests above the troughs")
            .at_least(0);
        group.value("across", dunes.across, "direction from crest to crest");
        group.expect(dunes.across[0] != 0 || dunes.across[1] != 0, "across", "must not be zero");
        group.value("wavelength_m", dunes.wavelength_m, "from crest to crest").above(0);
        expect_few_waves(group, "wavelength_m", dunes.wavelength_m);
        group.value("rise", dunes.rise, "share of a wavelength on the gentle side")
            .range(0.05, 0.95);
        group.value("bend_m", dunes.bend_m, "how far crests stray from straight lines").at_least(0);
        group.value("bend_wavelength_m", dunes.bend_wavelength_m, "how often").above(0);
        expect_few_waves(group, "bend_wavelength_m", dunes.bend_wavelength_m);
      },
      "rows of dunes with crests that bend, rise and sink");
  fields.group(
      "swell",
      [&](config::Fields& group) {
        auto& swell = options.swell;
        group.value("height_m", swell.height_m, "largest deviation from flat").at_least(0);
        group.value("wavelength_m", swell.wavelength_m, "shortest and longest").above(0);
        group.expect(swell.wavelength_m[0] <= swell.wavelength_m[1], "wavelength_m",
                     "must not fall: the smaller number comes first");
        expect_few_waves(group, "wavelength_m", swell.wavelength_m[0]);
      },
      "smooth bumps of many sizes");
}

ReliefOptions read_relief_options(const std::filesystem::path& file) {
  return config::read<ReliefOptions>(config::load(file));
}

}  // namespace saccade
