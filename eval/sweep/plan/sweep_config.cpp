#include "eval/sweep/plan/sweep_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "core/config/suggest.h"
#include "core/io/files/folder_name.h"

namespace saccade {
namespace {

/// The first name that occurs twice; empty where all differ.
template <class Named>
std::string repeated_name(const std::vector<Named>& items) {
  std::set<std::string> seen;
  for (const Named& item : items)
    if (!seen.insert(item.name).second) return item.name;
  return {};
}

template <class Named>
void expect_names_differ(config::Fields& fields, const char* key, const std::vector<Named>& items) {
  const std::string name = repeated_name(items);
  fields.expect(name.empty(), key, "holds the name '" + name + "' twice");
}

void expect_seeds_differ(config::Fields& fields, const std::vector<std::uint64_t>& seeds) {
  const std::set<std::uint64_t> different(seeds.begin(), seeds.end());
  fields.expect(different.size() == seeds.size(), "seeds", "holds a seed twice");
}

/// Seeds belong to the key `seeds`, so that results can be averaged over them.
template <class Keyed>
void expect_no_seed(config::Fields& fields, const char* key, const std::vector<Keyed>& items) {
  const bool stated =
      std::any_of(items.begin(), items.end(), [](const Keyed& item) { return item.key == "seed"; });
  fields.expect(!stated, key, "must not hold 'seed'; state it in 'seeds'");
}

template <class Named>
const Named* find_named(std::span<const Named> items, const std::string& name) {
  for (const Named& item : items)
    if (item.name == name) return &item;
  return nullptr;
}

/// The configuration named by `from` must precede and run over the same datasets and seeds.
void expect_source(config::Fields& fields, const SweepConfig& sweep, std::size_t index,
                   const char* key, const std::string& from) {
  if (from.empty()) return;
  const SweepConfiguration& user = sweep.configurations[index];
  const auto before = std::span(sweep.configurations).first(index);
  const SweepConfiguration* source = find_named(before, from);
  fields.expect(
      source != nullptr, "configurations",
      fmt::format("{}: '{}' of '{}' is not a configuration before it", key, from, user.name));
  if (source == nullptr) return;
  const std::vector<std::uint64_t>& given = sweep.seeds_of(*source);
  for (const std::uint64_t seed : sweep.seeds_of(user))
    fields.expect(std::find(given.begin(), given.end(), seed) != given.end(), "configurations",
                  fmt::format("'{}' has the seed {}, but '{}', which it starts from, does not",
                              user.name, seed, from));
  for (const std::string& dataset : sweep.dataset_names())
    fields.expect(!user.runs_over(dataset) || source->runs_over(dataset), "configurations",
                  fmt::format("'{}' runs over {}, but '{}', which it starts from, does not",
                              user.name, dataset, from));
  fields.expect(user.every % source->every == 0, "configurations",
                fmt::format("'{}' runs over datasets that '{}', which it starts from, leaves out: "
                            "'every' must be a multiple of {}",
                            user.name, from, source->every));
}

void expect_datasets(config::Fields& fields, const char* key, const SweepConfig& sweep,
                     const std::vector<std::string>& names) {
  const std::vector<std::string> known = sweep.dataset_names();
  for (const std::string& name : names)
    fields.expect(std::find(known.begin(), known.end(), name) != known.end(), key,
                  fmt::format("'{}' is not a dataset of the sweep; {}", name,
                              config::suggestion(name, known, "datasets")));
}

/// An earlier dataset, simulated once or with the same seeds.
void check_truths(config::Fields& fields, const SweepConfig& sweep) {
  std::vector<std::string> earlier;
  for (const SweepDataset& dataset : sweep.datasets) {
    if (!dataset.against.empty()) {
      const SweepDataset* truth = find_named(std::span(sweep.datasets), dataset.against);
      const bool is_earlier =
          std::find(earlier.begin(), earlier.end(), dataset.against) != earlier.end();
      fields.expect(
          is_earlier, "datasets",
          fmt::format("'{}', which '{}' is scored against, is not a dataset before it; {}",
                      dataset.against, dataset.name,
                      config::suggestion(dataset.against, earlier, "datasets")));
      // An external simulator has no seeds of its own: it runs over each of the truth's datasets.
      fields.expect(dataset.adapter || truth->seeds.size() < 2 || truth->seeds == dataset.seeds,
                    "datasets",
                    fmt::format("'{}' must have the seeds of '{}', which it is scored against",
                                dataset.name, dataset.against));
      fields.expect(!truth->adapter, "datasets",
                    fmt::format("'{}' is of an external simulator and no truth", truth->name));
      fields.expect(sweep.configurations.empty(), "datasets",
                    fmt::format("'against' of '{}' is for sweeps without 'configurations', whose "
                                "rows are datasets",
                                dataset.name));
    }
    earlier.push_back(dataset.name);
  }
}

/// Rows are stopped one by one, so that none may be what another starts from.
void check_halving(config::Fields& fields, const SweepConfig& sweep) {
  if (!sweep.halving) return;
  fields.expect(!sweep.configurations.empty(), "halving", "needs 'configurations' to compare");
  fields.expect(!sweep.timing, "halving",
                "goes not with 'timing', whose speeds would be those of different pairs");
  for (const SweepConfiguration& configuration : sweep.configurations)
    fields.expect(
        configuration.from.empty() && configuration.poses_from.empty() &&
            configuration.depth_from.empty(),
        "halving",
        fmt::format("goes not with '{}', which starts from another run", configuration.name));
}

void check_configurations(config::Fields& fields, const SweepConfig& sweep) {
  for (std::size_t i = 0; i < sweep.configurations.size(); ++i) {
    const SweepConfiguration& configuration = sweep.configurations[i];
    expect_datasets(fields, "configurations", sweep, configuration.datasets);
    expect_seeds_differ(fields, configuration.seeds);
    expect_source(fields, sweep, i, "from", configuration.from);
    expect_source(fields, sweep, i, "poses_from", configuration.poses_from);
    expect_source(fields, sweep, i, "depth_from", configuration.depth_from);
  }
}

void check_expected(config::Fields& fields, const SweepConfig& sweep) {
  std::vector<std::string> names;
  for (const SweepConfiguration& configuration : sweep.configurations)
    names.push_back(configuration.name);
  for (const ExpectedMetric& expected : sweep.expected) {
    const bool is_known =
        find_named(std::span(sweep.configurations), expected.configuration) != nullptr;
    fields.expect(
        is_known, "expected",
        fmt::format("'{}' is not a configuration of the sweep; {}", expected.configuration,
                    config::suggestion(expected.configuration, names, "configurations")));
    expect_datasets(fields, "expected", sweep, expected.datasets);
  }
}

}  // namespace

std::vector<std::string> SweepConfig::dataset_names() const {
  std::vector<std::string> names;
  for (const SweepDataset& dataset : datasets) names.push_back(dataset.name);
  if (generate)
    for (const GenerateScene& scene : generate->scenes) names.push_back(scene.name);
  return names;
}

bool SweepConfiguration::runs_over(const std::string& dataset) const {
  return datasets.empty() || std::find(datasets.begin(), datasets.end(), dataset) != datasets.end();
}

void describe(config::Fields& fields, SweepDataset& dataset) {
  fields.value("name", dataset.name,
               "Name of the dataset in tables and folders. Default: that of the folder or file.");
  fields.value("optional", dataset.is_optional,
               "Whether the sweep goes on without this dataset where 'path' does not exist, as of "
               "recordings that not everybody has.");
  config::Rule path = fields.path("path", dataset.path, "A dataset folder. Excludes 'simulate'.");
  if (!dataset.is_optional) path.must_exist();
  fields.expect(!dataset.is_optional || dataset.path, "optional", "belongs to 'path'");
  fields.configuration("simulate", dataset.simulate,
                       "A simulation configuration that makes the dataset: a file, or the name of "
                       "a shipped one such as walls.");
  fields
      .path("adapter", dataset.adapter,
            "Adapter file of an external simulator, which makes the events from the dataset that "
            "'against' names.")
      .must_exist();
  fields.value("against", dataset.against,
               "Name of an earlier dataset of the sweep. Its events are the truth that those of "
               "this one are scored against (events.*).");
  fields.value("set", dataset.set,
               "Overrides of the simulation configuration or of the adapter, as `key.path: "
               "value`.");
  fields.value("seeds", dataset.seeds,
               "Seeds of the simulation; each makes a dataset. Default: the seed it states.");
  fields.expect(
      dataset.path.has_value() + dataset.simulate.has_value() + dataset.adapter.has_value() == 1,
      "path", "must be stated, or 'simulate', or 'adapter', and one of them alone");
  fields.expect(!dataset.path || (dataset.set.empty() && dataset.against.empty()), "path",
                "names a finished dataset: 'set' and 'against' belong to what makes one");
  fields.expect(dataset.simulate || dataset.seeds.empty(), "seeds",
                "belong to 'simulate'; an 'adapter' runs over all seeds of 'against'");
  fields.expect(!dataset.adapter || !dataset.against.empty(), "adapter",
                "needs 'against': the dataset from which the program makes its events");
  expect_seeds_differ(fields, dataset.seeds);
  expect_no_seed(fields, "set", dataset.set);
  if (!fields.reading() || !dataset.name.empty()) return;
  if (dataset.path) dataset.name = folder_name(*dataset.path);
  if (dataset.simulate) dataset.name = dataset.simulate->stem();
  if (dataset.adapter) dataset.name = dataset.adapter->stem();
}

void describe(config::Fields& fields, SweepConfiguration& configuration) {
  fields.value("name", configuration.name,
               "Name in tables. Default: that of the file, after the module where it is stated.");
  fields.value("module", configuration.module,
               "Module of `saccade run`. Default: that of the sweep.");
  fields.configuration("file", configuration.file,
                       "Configuration of the module: a file, or the name of a shipped one such as "
                       "tracking/best. Default: the module's default values.");
  fields
      .path("adapter", configuration.adapter,
            "Adapter file of an external program, which runs in place of the module.")
      .must_exist();
  fields.value("set", configuration.set, "Overrides of the file, as `key.path: value`.");
  fields.expect(!configuration.file || !configuration.adapter, "file",
                "must not be stated beside 'adapter'");
  expect_no_seed(fields, "set", configuration.set);
  fields.value("datasets", configuration.datasets,
               "Names of the datasets that it runs over, or scenes of generated ones. Default: "
               "all.");
  fields
      .value("every", configuration.every,
             "Runs over each of so many generated datasets alone, those whose index it divides.")
      .range(1, 1e6);
  fields.value("seeds", configuration.seeds, "Seeds of the runs. Default: those of the sweep.");
  fields
      .value("repeat", configuration.repeat,
             "Repetitions of each run for its timing. Default: that of the sweep.")
      .range(1, 100000);
  fields.value("from", configuration.from,
               "Name of an earlier configuration whose run is the input of `refine` (--from).");
  fields.value("poses_from", configuration.poses_from,
               "Name of an earlier configuration whose poses replace the true ones.");
  fields.value("depth_from", configuration.depth_from,
               "Name of an earlier configuration whose depth replaces the true one.");
  if (!fields.reading() || !configuration.name.empty()) return;
  configuration.name = "defaults";
  if (configuration.file) configuration.name = configuration.file->stem();
  if (configuration.adapter) configuration.name = configuration.adapter->stem();
  if (!configuration.module.empty() && !configuration.adapter)
    configuration.name = configuration.module + " " + configuration.name;
}

void describe(config::Fields& fields, ExpectedMetric& expected) {
  fields.value("configuration", expected.configuration, "Name of the configuration.").required();
  fields.value("datasets", expected.datasets,
               "Names of the datasets. Default: all that the configuration runs over.");
  fields.value("metric", expected.metric, "Key of metrics.json.").required();
  fields
      .value("at_most", expected.at_most,
             "Upper bound of the mean over the seeds; of a speed, of the median.")
      .range(-1e12, 1e12);
  fields
      .value("at_least", expected.at_least,
             "Lower bound of the mean over the seeds; of a speed, of the median.")
      .range(-1e12, 1e12);
  fields.expect(expected.at_most || expected.at_least, "metric", "needs 'at_most' or 'at_least'");
}

void describe(config::Fields& fields, SweepVariant& variant) {
  fields.value("name", variant.name, "Name of the variant in tables.").required();
  fields.value("set", variant.set, "Overrides of the configuration, as `key.path: value`.");
  fields.expect(!variant.name.empty(), "name", "must not be empty");
  expect_no_seed(fields, "set", variant.set);
}

namespace {

void check_reference(config::Fields& fields, const SweepConfig& sweep) {
  if (sweep.reference.empty()) return;
  std::vector<std::string> names;
  for (const SweepVariant& variant : sweep.variants) names.push_back(variant.name);
  for (const SweepConfiguration& configuration : sweep.configurations)
    names.push_back(configuration.name);
  fields.expect(std::find(names.begin(), names.end(), sweep.reference) != names.end(), "reference",
                fmt::format("names no variant and no configuration; {}",
                            config::suggestion(sweep.reference, names, "names")));
}

/// What runs: the axes of the sweep.
void describe_axes(config::Fields& fields, SweepConfig& sweep) {
  fields.value("module", sweep.module, "Module of `saccade run`.");
  fields.section("generate", sweep.generate,
                 "Simulates many datasets with sampled parameters, in place of 'datasets'. "
                 "Results over them are grouped by their scenes.");
  config::Rule datasets = fields.list(
      "datasets", sweep.datasets,
      "Datasets, each {name, path} or {name, simulate, set, seeds, against}, or, of an external "
      "simulator, {name, adapter, set, against}.");
  if (!sweep.generate) datasets.required().length(1, config::Rule::kAnyLength);
  fields.list(
      "configurations", sweep.configurations,
      "Configurations that run over the datasets, each {name, module, file or adapter, set, "
      "datasets, every, seeds, repeat, from, poses_from, depth_from}. None: simulate only.");
  fields.list("variants", sweep.variants,
              "Named overrides, each {name, set}. Every configuration runs with each of them.");
  fields.value("grid", sweep.grid,
               "Lists of values, as `key.path: [value, ...]`. Every combination runs.");
  fields.choice("plan", sweep.plan,
                {{"factorial", GridPlan::kFactorial}, {"one_at_a_time", GridPlan::kOneAtATime}},
                "Points of the grid: every combination, or the first values of all keys and every "
                "other value of one key beside them.");
  fields.section("halving", sweep.halving,
                 "Stops rows without hope early (successive halving): all rows run over few pairs "
                 "of dataset and seed, the better of them over twice as many, and so on.");
  fields.value("seeds", sweep.seeds,
               "Seeds of the runs. Results are averaged over them. Default: the configuration's.");
}

/// How it runs and what of it is shown.
void describe_execution(config::Fields& fields, SweepConfig& sweep) {
  fields
      .value("repeat", sweep.repeat,
             "Repetitions of each run for its timing. More give a more reliable median and take "
             "longer.")
      .range(1, 100000);
  fields.value("timing", sweep.timing,
               "Run one job at a time on one thread, so that speeds can be compared.");
  fields
      .value("threads", sweep.threads,
             "Threads of one run or of one generated dataset. More threads leave room for fewer "
             "parallel jobs.")
      .range(1, 4096);
  fields
      .value("duration_s", sweep.duration_s,
             "Time that is run, in seconds from the first event. Default: the whole recording.")
      .above(0);
  fields.value("metrics", sweep.metrics,
               "Keys of metrics.json that sweep.md and its charts show. Default: the usual ones.");
  fields.value("reference", sweep.reference,
               "Variant or configuration that all others are tested against (ablation.csv, "
               "ablation.tex and a part of sweep.md). Default: none.");
  fields.list(
      "expected", sweep.expected,
      "Metrics that a benchmark must reach, each {configuration, datasets, metric, at_most, "
      "at_least}. One that is missed ends the sweep with exit code 1.");
}

}  // namespace

void describe(config::Fields& fields, SweepConfig& sweep) {
  fields.value("title", sweep.title, "Title of sweep.md.");
  describe_axes(fields, sweep);
  describe_execution(fields, sweep);
  expect_names_differ(fields, "datasets", sweep.datasets);
  expect_names_differ(fields, "configurations", sweep.configurations);
  expect_names_differ(fields, "variants", sweep.variants);
  expect_seeds_differ(fields, sweep.seeds);
  expect_no_seed(fields, "grid", sweep.grid);
  fields.expect(!sweep.timing || sweep.threads == 1, "threads", "must be 1 where 'timing' is true");
  const bool generates = sweep.generate.has_value();
  fields.expect(!generates || !sweep.generate->disk_gb || sweep.configurations.empty(), "generate",
                "with 'disk_gb' makes datasets alone, without 'configurations'");
  fields.expect(!generates || sweep.datasets.empty(), "generate", "takes the place of 'datasets'");
  for (const SweepConfiguration& configuration : sweep.configurations)
    fields.expect(generates || configuration.every == 1, "configurations",
                  fmt::format("'every' of '{}' is for generated datasets", configuration.name));
  const bool has_adapters =
      std::any_of(sweep.configurations.begin(), sweep.configurations.end(),
                  [](const SweepConfiguration& c) { return c.adapter.has_value(); });
  fields.expect(!has_adapters || (sweep.grid.empty() && sweep.variants.empty()), "configurations",
                "must not hold an 'adapter' beside 'grid' or 'variants', which are keys of the "
                "module");
  const bool simulates_only = sweep.configurations.empty();
  fields.expect(!simulates_only || sweep.grid.empty(), "grid", "needs 'configurations' to vary");
  fields.expect(!simulates_only || sweep.variants.empty(), "variants",
                "need 'configurations' to vary");
  if (!fields.reading()) return;
  check_truths(fields, sweep);
  check_reference(fields, sweep);
  check_halving(fields, sweep);
  check_configurations(fields, sweep);
  check_expected(fields, sweep);
}

std::vector<std::string> leave_out_absent(SweepConfig& sweep) {
  std::vector<std::string> messages;
  std::set<std::string> absent;
  for (const SweepDataset& dataset : sweep.datasets)
    if (dataset.is_optional && !std::filesystem::exists(*dataset.path)) {
      absent.insert(dataset.name);
      messages.push_back(fmt::format("{} is left out: {} does not exist", dataset.name,
                                     dataset.path->lexically_normal().string()));
    }
  std::erase_if(sweep.datasets, [&](const SweepDataset& d) { return absent.contains(d.name); });
  // An empty list of datasets would mean all of them.
  const auto is_of_absent_alone = [&](auto& one) {
    const bool had_some = !one.datasets.empty();
    std::erase_if(one.datasets, [&](const std::string& name) { return absent.contains(name); });
    return had_some && one.datasets.empty();
  };
  std::set<std::string> left_out;
  std::erase_if(sweep.configurations, [&](SweepConfiguration& configuration) {
    const bool is_left_out = is_of_absent_alone(configuration);
    if (is_left_out) left_out.insert(configuration.name);
    return is_left_out;
  });
  std::erase_if(sweep.expected, [&](ExpectedMetric& expected) {
    return is_of_absent_alone(expected) || left_out.contains(expected.configuration);
  });
  return messages;
}

}  // namespace saccade
