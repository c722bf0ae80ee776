#include "eval/sweep/plan/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/config/convert.h"
#include "core/config/yaml_emit.h"

namespace saccade {
namespace {

using config::Node;

/// Simulation seeds fit 31 bits, which every program can read.
constexpr std::uint64_t kSeeds = 1ULL << 31;

const GenerateScene& sample_scene(const GenerateConfig& generate, std::uint64_t index) {
  std::uint64_t all = 0;
  for (const GenerateScene& scene : generate.scenes)
    all += static_cast<std::uint64_t>(scene.weight);
  std::uint64_t left = sample_below(all, "generate.scenes", generate.seed, index);
  for (const GenerateScene& scene : generate.scenes) {
    const auto weight = static_cast<std::uint64_t>(scene.weight);
    if (left < weight) return scene;
    left -= weight;
  }
  return generate.scenes.back();
}

/// Datasets come in blocks of train + val + test; in each block the parts are shuffled (Fisher and
/// Yates), so that a dataset's part does not depend on how many there are.
std::string split_of(const GenerateConfig& generate, std::uint64_t index) {
  const auto [train, val, test] = generate.split;
  const int unit = std::gcd(train, std::gcd(val, test));
  std::vector<const char*> parts;
  const auto add = [&](const char* name, int size) {
    parts.insert(parts.end(), static_cast<std::size_t>(size / unit), name);
  };
  add("train", train);
  add("val", val);
  add("test", test);
  const std::uint64_t block = index / parts.size();
  for (std::size_t left = parts.size(); left > 1; --left)
    std::swap(
        parts[left - 1],
        parts[sample_below(left, fmt::format("generate.split.{}", left), generate.seed, block)]);
  return parts[index % parts.size()];
}

/// The parameters of all scenes, replaced by the scene's own where the key is the same.
SampledParameters parameters_of(const GenerateConfig& generate, const GenerateScene& scene) {
  SampledParameters parameters = generate.draw;
  for (const config::Entry& entry : scene.draw.keys.entries) {
    if (config::Entry* general = parameters.keys.find(entry.key))
      general->value = entry.value;
    else
      parameters.keys.entries.push_back(entry);
  }
  return parameters;
}

void flatten(const Node& node, const std::string& path,
             std::vector<std::pair<std::string, std::string>>& values) {
  for (std::size_t i = 0; i < node.items.size(); ++i)
    flatten(node.items[i], fmt::format("{}.{}", path, i), values);
  for (const config::Entry& entry : node.entries)
    flatten(entry.value, path + "." + entry.key, values);
  if (node.kind == Node::Kind::kScalar) values.emplace_back(path, node.text);
}

bool holds_seed(const SampledParameters& parameters) {
  return parameters.keys.find("seed") != nullptr;
}

bool holds_seed(const Settings& settings) {
  return std::any_of(settings.begin(), settings.end(),
                     [](const Setting& setting) { return setting.key == "seed"; });
}

template <class Described>
void describe_overrides(config::Fields& fields, Described& described, const char* of) {
  fields.value(
      "set", described.set,
      fmt::format("Overrides of the simulation configuration {}, as `key.path: value`.", of));
  fields.value(
      "draw", described.draw,
      fmt::format("Sampled parameters {}, as `key.path: value` where a value or a part of it "
                  "is a distribution. They are applied after all of 'set'.",
                  of));
  const char* kSeedProblem = "must not hold 'seed'; every dataset gets its own";
  fields.expect(!holds_seed(described.set), "set", kSeedProblem);
  fields.expect(!holds_seed(described.draw), "draw", kSeedProblem);
}

}  // namespace

void describe(config::Fields& fields, GenerateSplit& split) {
  constexpr double kLargest = 1000;
  fields.value("train", split.train, "Relative size of the part for training.").range(0, kLargest);
  fields.value("val", split.val, "Relative size of the part for validation.").range(0, kLargest);
  fields.value("test", split.test, "Relative size of the part for tests.").range(0, kLargest);
  fields.expect(split.train + split.val + split.test > 0, "train", "must not be 0 like all others");
}

void describe(config::Fields& fields, GenerateScene& scene) {
  fields.value("name", scene.name, "Name of the scene in the manifest. Default: that of the file.");
  fields.path("simulate", scene.simulate, "Simulation configuration that datasets are made from.")
      .required()
      .must_exist();
  fields
      .value("weight", scene.weight,
             "Relative probability of this scene; 2 is chosen twice as often as 1.")
      .range(1, 1e6);
  fields
      .value("split", scene.split,
             "Part that all datasets of this scene belong to: train, val or test, for scenes that "
             "the others never show; any: that of the dataset.")
      .one_of({"any", "train", "val", "test"});
  describe_overrides(fields, scene, "of this scene");
  if (fields.reading() && scene.name.empty()) scene.name = scene.simulate.stem();
}

void describe(config::Fields& fields, GenerateConfig& generate) {
  fields.value("name", generate.name, "Name of the datasets: NAME-000417 is dataset 417.");
  fields.value("first", generate.first, "Index of the first dataset.").range(0, 999999);
  fields.value("count", generate.count, "Number of datasets.").required().range(1, 1000000);
  fields.value("seed", generate.seed, "Seed of all sampled parameters.");
  fields.section(
      "split", generate.split,
      "Relative sizes of the parts, as whole numbers. Of as many consecutive datasets as "
      "their sum, after division by their greatest common divisor, each part gets exactly "
      "its number, in an order that the seed shuffles.");
  fields
      .value("shards", generate.shards,
             "Number of folders that the datasets are divided among, in turn: data/shard-00 and so "
             "on. 1: all are in data.")
      .range(1, 10000);
  fields.value("classes", generate.classes,
               "Names of the classes 1, 2 and so on in the labels of all scenes (scene.classes).");
  fields
      .list("scenes", generate.scenes,
            "Scenes, each {simulate, name, weight, split, set, draw}. Every dataset samples one of "
            "them.")
      .required()
      .length(1, config::Rule::kAnyLength);
  describe_overrides(fields, generate, "of all scenes");
  fields.expect(!generate.name.empty(), "name", "must not be empty");
  std::set<std::string> names;
  for (const GenerateScene& scene : generate.scenes) names.insert(scene.name);
  fields.expect(names.size() == generate.scenes.size(), "scenes", "hold a name twice");
}

GeneratedDataset generated_dataset(const GenerateConfig& generate, std::uint64_t index) {
  GeneratedDataset dataset;
  dataset.index = index;
  dataset.name = fmt::format("{}-{:06}", generate.name, index);
  dataset.scene = &sample_scene(generate, index);
  dataset.seed = sample_below(kSeeds, "seed", generate.seed, index);
  dataset.split = dataset.scene->split == "any" ? split_of(generate, index) : dataset.scene->split;
  dataset.shard = static_cast<int>(index % static_cast<std::uint64_t>(generate.shards));
  if (!generate.classes.empty())
    dataset.settings.push_back(
        {"scene.classes", config::to_flow_yaml(config::to_node(generate.classes))});
  for (const Settings* settings : {&generate.set, &dataset.scene->set})
    dataset.settings.insert(dataset.settings.end(), settings->begin(), settings->end());
  const Node sampled = sample_values(parameters_of(generate, *dataset.scene), generate.seed, index);
  for (const config::Entry& entry : sampled.entries) {
    dataset.settings.push_back({entry.key, config::to_flow_yaml(entry.value)});
    flatten(entry.value, entry.key, dataset.sampled);
  }
  return dataset;
}

}  // namespace saccade
