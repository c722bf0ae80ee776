#include "simulator/scene/mesh/relief_options.h"

#include <algorithm>

#include "core/config/config.h"

namespace saccade {
namespace {

constexpr double kMaxTriangles = 4e6;
constexpr double kMaxWaves = 2048;

}  // namespace

void describe(config::Fields& fields, ReliefOptions& options) {
  fields.value("size_m", options.size_m, "Size along x and y, in metres.").above(0);
  fields
      .value("triangles", options.triangles,
             "Approximate number of triangles; the shape does not depend on it.")
      .range(2, kMaxTriangles);
  fields.value("seed", options.seed,
               "Seed; another seed gives another relief with the same statistics.");
  fields.path("texture", options.texture, "Picture or *.texture.yaml that covers the whole relief.")
      .must_exist();
  fields.value("albedo", options.albedo, "Albedo without a texture, in linear light.").range(0, 1);
  const double side = std::max(options.size_m[0], options.size_m[1]);
  const auto expect_few_waves = [side](config::Fields& group, std::string_view key,
                                       double wavelength) {
    group.expect(side / wavelength <= kMaxWaves, key, "must fit at most 2048 times into size_m");
  };
  fields.group(
      "dunes",
      [&](config::Fields& group) {
        auto& dunes = options.dunes;
        group
            .value(
                "height_m", dunes.height_m,
                "Height of the highest crests above the troughs, in metres. 0 disables the dunes.")
            .at_least(0);
        group
            .value("across", dunes.across,
                   "Direction from crest to crest; its length does not matter.")
            .range(-1e6, 1e6);
        group.expect(dunes.across[0] != 0 || dunes.across[1] != 0, "across", "must not be zero");
        group.value("wavelength_m", dunes.wavelength_m, "Distance from crest to crest, in metres.")
            .above(0);
        expect_few_waves(group, "wavelength_m", dunes.wavelength_m);
        group.value("rise", dunes.rise, "Fraction of a wavelength on the gentle side of a dune.")
            .range(0.05, 0.95);
        group
            .value("bend_m", dunes.bend_m,
                   "Largest displacement of the crests from straight lines, in metres.")
            .at_least(0);
        group
            .value("bend_wavelength_m", dunes.bend_wavelength_m,
                   "Wavelength of that displacement and of the crests' height, in metres.")
            .above(0);
        expect_few_waves(group, "bend_wavelength_m", dunes.bend_wavelength_m);
      },
      "Rows of dunes whose crests bend, rise and sink.");
  fields.group(
      "swell",
      [&](config::Fields& group) {
        auto& swell = options.swell;
        group
            .value("height_m", swell.height_m,
                   "Largest height of the swell, in metres. 0 disables the swell.")
            .at_least(0);
        group
            .value("wavelength_m", swell.wavelength_m,
                   "Shortest and longest wavelength of the swell, in metres.")
            .above(0);
        group.expect(swell.wavelength_m[0] <= swell.wavelength_m[1], "wavelength_m",
                     "must not fall: the smaller number comes first");
        expect_few_waves(group, "wavelength_m", swell.wavelength_m[0]);
      },
      "Smooth bumps of many sizes.");
}

ReliefOptions read_relief_options(const std::filesystem::path& file) {
  return config::read<ReliefOptions>(config::load(file));
}

}  // namespace saccade
