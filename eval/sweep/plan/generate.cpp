#include "eval/sweep/plan/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/config/yaml_emit.h"

namespace saccade {
namespace {

using config::Node;

/// Seeds that people can read and other programs hold in 32 bits.
constexpr std::uint64_t kSeeds = 1ULL << 31;

const GenerateScene& draw_scene(const GenerateConfig& generate, const DrawIdentity& identity) {
  std::uint64_t all = 0;
  for (const GenerateScene& scene : generate.scenes)
    all += static_cast<std::uint64_t>(scene.weight);
  std::uint64_t drawn = sample_below(all, "generate.scenes", identity);
  for (const GenerateScene& scene : generate.scenes) {
    const auto weight = static_cast<std::uint64_t>(scene.weight);
    if (drawn < weight) return scene;
    drawn -= weight;
  }
  return generate.scenes.back();
}

/// Those of all scenes, with the scene's own in the place of those of the same key.
SampledParameters draws_of(const GenerateConfig& generate, const GenerateScene& scene) {
  SampledParameters draws = generate.draw;
  for (const config::Entry& entry : scene.draw.keys.entries) {
    if (config::Entry* general = draws.keys.find(entry.key))
      general->value = entry.value;
    else
      draws.keys.entries.push_back(entry);
  }
  return draws;
}

void flatten(const Node& node, const std::string& path,
             std::vector<std::pair<std::string, std::string>>& values) {
  for (std::size_t i = 0; i < node.items.size(); ++i)
    flatten(node.items[i], fmt::format("{}.{}", path, i), values);
  for (const config::Entry& entry : node.entries)
    flatten(entry.value, path + "." + entry.key, values);
  if (node.kind == Node::Kind::kScalar) values.emplace_back(path, node.text);
}

bool holds_seed(const SampledParameters& draws) { return draws.keys.find("seed") != nullptr; }

bool holds_seed(const Settings& settings) {
  return std::any_of(settings.begin(), settings.end(),
                     [](const Setting& setting) { return setting.key == "seed"; });
}

template <class Described>
void describe_settings(config::Fields& fields, Described& described, const char* of) {
  fields.value("set", described.set, fmt::format("overrides {}, key.path: value", of));
  fields.value("draw", described.draw, "key.path: value with distributions; after 'set'");
  const char* kSeedProblem = "must not hold 'seed'; every dataset gets one of its own";
  fields.expect(!holds_seed(described.set), "set", kSeedProblem);
  fields.expect(!holds_seed(described.draw), "draw", kSeedProblem);
}

}  // namespace

void describe(config::Fields& fields, GenerateScene& scene) {
  fields.value("name", scene.name, "default: the file's");
  fields.path("simulate", scene.simulate, "a simulation configuration").required().must_exist();
  fields.value("weight", scene.weight, "how often it is drawn, compared with the others")
      .range(1, 1e6);
  describe_settings(fields, scene, "of this scene");
  if (fields.reading() && scene.name.empty()) scene.name = scene.simulate.stem();
}

void describe(config::Fields& fields, GenerateConfig& generate) {
  fields.value("name", generate.name, "of the datasets, before their index");
  fields.value("first", generate.first, "index of the first dataset").range(0, 999999);
  fields.value("count", generate.count, "datasets").required().range(1, 1000000);
  fields.value("seed", generate.seed, "of all draws");
  fields.list("scenes", generate.scenes, "each {simulate, name, weight, set, draw}")
      .required()
      .length(1, config::Rule::kAnyLength);
  describe_settings(fields, generate, "of all scenes");
  fields.expect(!generate.name.empty(), "name", "must not be empty");
  std::set<std::string> names;
  for (const GenerateScene& scene : generate.scenes) names.insert(scene.name);
  fields.expect(names.size() == generate.scenes.size(), "scenes", "hold a name twice");
}

GeneratedDataset generated_dataset(const GenerateConfig& generate, std::uint64_t index) {
  const DrawIdentity identity{generate.seed, index};
  GeneratedDataset dataset;
  dataset.index = index;
  dataset.name = fmt::format("{}-{:06}", generate.name, index);
  dataset.scene = &draw_scene(generate, identity);
  dataset.seed = sample_below(kSeeds, "seed", identity);
  for (const Settings* settings : {&generate.set, &dataset.scene->set})
    dataset.settings.insert(dataset.settings.end(), settings->begin(), settings->end());
  const Node drawn = sample_values(draws_of(generate, *dataset.scene), identity);
  for (const config::Entry& entry : drawn.entries) {
    dataset.settings.push_back({entry.key, config::to_flow_yaml(entry.value)});
    flatten(entry.value, entry.key, dataset.drawn);
  }
  return dataset;
}

}  // namespace saccade
