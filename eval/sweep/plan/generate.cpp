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

/// One of the items, by their weights.
template <class Weighted>
const Weighted& sample_by_weight(const std::vector<Weighted>& items, const char* path,
                                 std::uint64_t seed, std::uint64_t index) {
  std::uint64_t all = 0;
  for (const Weighted& item : items) all += static_cast<std::uint64_t>(item.weight);
  std::uint64_t left = sample_below(all, path, seed, index);
  for (const Weighted& item : items) {
    const auto weight = static_cast<std::uint64_t>(item.weight);
    if (left < weight) return item;
    left -= weight;
  }
  return items.back();
}

const GenerateScene& scene_of(const GenerateConfig& generate, std::uint64_t index) {
  if (generate.scenes_in_turn || generate.paired)
    return generate.scenes[index % generate.scenes.size()];
  return sample_by_weight(generate.scenes, "generate.scenes", generate.seed, index);
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

void replace(SampledParameters& parameters, const SampledParameters& by) {
  for (const config::Entry& entry : by.keys.entries) {
    if (config::Entry* general = parameters.keys.find(entry.key))
      general->value = entry.value;
    else
      parameters.keys.entries.push_back(entry);
  }
}

/// The parameters of all scenes, replaced by those of the case and then by the scene's own where
/// the key is the same.
SampledParameters parameters_of(const GenerateConfig& generate, const GenerateCase* part,
                                const GenerateScene& scene) {
  SampledParameters parameters = generate.draw;
  if (part != nullptr) replace(parameters, part->draw);
  replace(parameters, scene.draw);
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
  fields
      .configuration("simulate", scene.simulate,
                     "Simulation configuration that datasets are made from: a file, or the name of "
                     "a shipped one such as walls.")
      .required();
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

void describe(config::Fields& fields, GenerateCase& part) {
  fields.value("name", part.name, "Name of the case in the manifest.").required();
  fields
      .value("weight", part.weight,
             "Relative probability of this case; 2 is chosen twice as often as 1.")
      .range(1, 1e6);
  describe_overrides(fields, part, "of this case");
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
      .value(
          "disk_gb", generate.disk_gb,
          "Space that the datasets may take, in gigabytes: as many are made as fit by the mean of "
          "those that are there. Default: not limited.")
      .above(0);
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
  fields.value("scenes_in_turn", generate.scenes_in_turn,
               "Whether the scenes take turns, so that each has as many datasets as the others, "
               "instead of being sampled by their weights.");
  fields.value("paired", generate.paired,
               "Whether the scenes take turns and as many consecutive datasets as there are scenes "
               "share all samples and the seed, so that they differ in what their scenes set. "
               "Dataset k has the samples of index k / number of scenes, rounded down: a paired "
               "comparison of settings of the simulator.");
  fields.list("cases", generate.cases,
              "Overrides and distributions that belong together, each {name, weight, set, draw}: "
              "every dataset samples one of them beside its scene. By default there are none.");
  describe_overrides(fields, generate, "of all scenes");
  fields.expect(!generate.name.empty(), "name", "must not be empty");
  std::set<std::string> names;
  for (const GenerateScene& scene : generate.scenes) names.insert(scene.name);
  fields.expect(names.size() == generate.scenes.size(), "scenes", "hold a name twice");
  std::set<std::string> cases;
  for (const GenerateCase& part : generate.cases) cases.insert(part.name);
  fields.expect(cases.size() == generate.cases.size(), "cases", "hold a name twice");
}

GeneratedDataset generated_dataset(const GenerateConfig& generate, std::uint64_t index) {
  GeneratedDataset dataset;
  dataset.index = index;
  dataset.name = fmt::format("{}-{:06}", generate.name, index);
  dataset.scene = &scene_of(generate, index);
  const std::uint64_t sample = generate.paired ? index / generate.scenes.size() : index;
  if (!generate.cases.empty())
    dataset.part = &sample_by_weight(generate.cases, "generate.cases", generate.seed, sample);
  dataset.seed = sample_below(kSeeds, "seed", generate.seed, sample);
  dataset.split = dataset.scene->split == "any" ? split_of(generate, sample) : dataset.scene->split;
  dataset.shard = static_cast<int>(index % static_cast<std::uint64_t>(generate.shards));
  if (!generate.classes.empty())
    dataset.settings.push_back(
        {"scene.classes", config::to_flow_yaml(config::to_node(generate.classes))});
  const auto append = [&dataset](const Settings& settings) {
    dataset.settings.insert(dataset.settings.end(), settings.begin(), settings.end());
  };
  append(generate.set);
  if (dataset.part != nullptr) append(dataset.part->set);
  append(dataset.scene->set);
  const Node sampled =
      sample_values(parameters_of(generate, dataset.part, *dataset.scene), generate.seed, sample);
  for (const config::Entry& entry : sampled.entries) {
    dataset.settings.push_back({entry.key, config::to_flow_yaml(entry.value)});
    flatten(entry.value, entry.key, dataset.sampled);
  }
  return dataset;
}

}  // namespace saccade
