#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulator/scene/scene_builder.h"
#include "simulator/scene/texture/texture_generator.h"

namespace saccade {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr std::size_t kPacket = 16;

std::shared_ptr<const Texture> texture() {
  TextureOptions options;
  options.size_m = {4, 4};
  return std::make_shared<Texture>(generate_texture(options));
}

/// A height field of 2 n^2 triangles over [-4, 4]^2 around `z`.
Mesh terrain(std::uint32_t n, double relief, double z) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double u = static_cast<double>(j) / n;
      const double v = static_cast<double>(i) / n;
      mesh.vertices.emplace_back(8 * u - 4, 8 * v - 4,
                                 z + relief * std::sin(40 * u) * std::cos(31 * v));
      mesh.uvs.emplace_back(u, v);
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = i * (n + 1) + j;
      mesh.triangles.push_back({{k, k + 1, k + n + 2}, 0});
      mesh.triangles.push_back({{k, k + n + 2, k + n + 1}, 0});
    }
  mesh.materials = {Material{0.5, texture(), 1, nullptr}};
  return mesh;
}

/// 0: two quads, 1: 100 thousand triangles, 2: the same under three lights with shadows.
Scene scene(std::int64_t kind) {
  SceneBuilder builder;
  if (kind == 0) {
    builder.add(terrain(1, 0, 3), Eigen::Affine3d::Identity());
    builder.add(terrain(1, 0, 4), Eigen::Affine3d(Eigen::Translation3d(3, 0, 0)));
  } else {
    builder.add(terrain(224, 0.1, 3), Eigen::Affine3d::Identity());
  }
  LightOptions light;
  std::vector<LightOptions> lights;
  for (const double x : {-1.0, 0.0, 1.0}) {
    light.position = {x, 0.3, 0.5};
    lights.push_back(light);
  }
  if (kind == 2) builder.light(0.1, lights);
  return std::move(builder).build(Background(0.5));
}

/// All rays of a camera, in tiles of 4 x 4 pixels.
std::vector<Ray> camera_rays() {
  std::vector<Ray> rays;
  for (int y = 0; y < kHeight; y += 4)
    for (int x = 0; x < kWidth; x += 4)
      for (int k = 0; k < 16; ++k)
        rays.push_back({Eigen::Vector3d(0.1, 0.2, 0),
                        {(x + k % 4 - 119.5) / 200, (y + k / 4 - 89.5) / 200, 1}});
  return rays;
}

std::vector<TriangleId> look(const Scene& scene, const std::vector<Ray>& rays) {
  std::vector<TriangleId> triangles(rays.size());
  for (std::size_t i = 0; i < rays.size(); i += kPacket)
    scene.visible({&rays[i], kPacket}, {&triangles[i], kPacket});
  return triangles;
}

void BM_Visible(benchmark::State& state) {
  const Scene world = scene(state.range(0));
  const std::vector<Ray> rays = camera_rays();
  for (auto _ : state) benchmark::DoNotOptimize(look(world, rays));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}
BENCHMARK(BM_Visible)->ArgName("scene")->Arg(0)->Arg(1);

void BM_Shade(benchmark::State& state) {
  const Scene world = scene(state.range(0));
  const std::vector<Ray> rays = camera_rays();
  const std::vector<TriangleId> triangles = look(world, rays);
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      sum += world.shade(rays[i], triangles[i]).radiance;
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}
BENCHMARK(BM_Shade)->ArgName("scene")->Arg(0)->Arg(1)->Arg(2);

void BM_BuildTree(benchmark::State& state) {
  const Mesh mesh = terrain(224, 0.1, 3);
  for (auto _ : state) {
    SceneBuilder builder;
    builder.add(mesh, Eigen::Affine3d::Identity());
    benchmark::DoNotOptimize(std::move(builder).build(Background(0.5)));
  }
}
BENCHMARK(BM_BuildTree)->Unit(benchmark::kMillisecond);

void BM_GenerateTexture(benchmark::State& state) {
  TextureOptions options;
  options.size_m = {8, 8};
  options.texels_per_m = 256;
  for (auto _ : state) benchmark::DoNotOptimize(generate_texture(options));
}
BENCHMARK(BM_GenerateTexture)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace saccade
