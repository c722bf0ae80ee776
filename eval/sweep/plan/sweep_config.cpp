#include "eval/sweep/plan/sweep_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "core/config/suggest.h"
#include "core/io/folder_name.h"

namespace saccade {
namespace {

/// The first name that stands twice; empty when none does.
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

/// The seed of a job stands in its own key, so that rows can be averaged over it.
template <class Keyed>
void expect_no_seed(config::Fields& fields, const char* key, const std::vector<Keyed>& items) {
  const bool stated =
      std::any_of(items.begin(), items.end(), [](const Keyed& item) { return item.key == "seed"; });
  fields.expect(!stated, key, "must not hold 'seed'; state it in 'seeds'");
}

const SweepConfiguration* find_named(std::span<const SweepConfiguration> configurations,
                                     const std::string& name) {
  for (const SweepConfiguration& configuration : configurations)
    if (configuration.name == name) return &configuration;
  return nullptr;
}

/// Whatever it runs over, the configuration named by `from` before it has run over, too.
void expect_source(config::Fields& fields, const SweepConfig& sweep, std::size_t index,
                   const char* key, const std::string& from) {
  if (from.empty()) return;
  const SweepConfiguration& taker = sweep.configurations[index];
  const auto before = std::span(sweep.configurations).first(index);
  const SweepConfiguration* source = find_named(before, from);
  fields.expect(
      source != nullptr, "configurations",
      fmt::format("{}: '{}' of '{}' is no configuration before it", key, from, taker.name));
  if (source == nullptr) return;
  const std::vector<std::uint64_t>& given = sweep.seeds_of(*source);
  for (const std::uint64_t seed : sweep.seeds_of(taker))
    fields.expect(std::find(given.begin(), given.end(), seed) != given.end(), "configurations",
                  fmt::format("'{}' has the seed {}, but '{}', which it starts from, does not",
                              taker.name, seed, from));
  for (const SweepDataset& dataset : sweep.datasets)
    fields.expect(!taker.runs_over(dataset.name) || source->runs_over(dataset.name),
                  "configurations",
                  fmt::format("'{}' runs over {}, but '{}', which it starts from, does not",
                              taker.name, dataset.name, from));
}

void expect_datasets(config::Fields& fields, const char* key, const SweepConfig& sweep,
                     const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const SweepDataset& dataset : sweep.datasets) known.push_back(dataset.name);
  for (const std::string& name : names)
    fields.expect(std::find(known.begin(), known.end(), name) != known.end(), key,
                  fmt::format("'{}' is no dataset of the sweep; {}", name,
                              config::suggestion(name, known, "datasets")));
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
  for (const ExpectedMetric& figure : sweep.expected) {
    const bool is_known = find_named(sweep.configurations, figure.configuration) != nullptr;
    fields.expect(is_known, "expected",
                  fmt::format("'{}' is no configuration of the sweep; {}", figure.configuration,
                              config::suggestion(figure.configuration, names, "configurations")));
    expect_datasets(fields, "expected", sweep, figure.datasets);
  }
}

}  // namespace

bool SweepConfiguration::runs_over(const std::string& dataset) const {
  return datasets.empty() || std::find(datasets.begin(), datasets.end(), dataset) != datasets.end();
}

void describe(config::Fields& fields, SweepDataset& dataset) {
  fields.value("name", dataset.name, "in tables; default: the folder's or the file's");
  fields.path("path", dataset.path, "a dataset folder").must_exist();
  fields.path("simulate", dataset.simulate, "or a simulation configuration").must_exist();
  fields.value("set", dataset.set, "overrides of it, key.path: value");
  fields.value("seeds", dataset.seeds, "of the simulation, one dataset each");
  fields.expect(dataset.path.has_value() != dataset.simulate.has_value(), "path",
                "must be stated, or 'simulate', and not both");
  fields.expect(dataset.simulate || (dataset.set.empty() && dataset.seeds.empty()), "path",
                "names a finished dataset: 'set' and 'seeds' belong to 'simulate'");
  expect_seeds_differ(fields, dataset.seeds);
  expect_no_seed(fields, "set", dataset.set);
  if (!fields.reading() || !dataset.name.empty()) return;
  if (dataset.path) dataset.name = folder_name(*dataset.path);
  if (dataset.simulate) dataset.name = dataset.simulate->stem();
}

void describe(config::Fields& fields, SweepConfiguration& configuration) {
  fields.value("name", configuration.name, "in tables; default: the file's, after the module");
  fields.value("module", configuration.module, "what `saccade run` runs; default: the sweep's");
  fields.path("file", configuration.file, "of the module; ~ is its defaults").must_exist();
  fields.path("adapter", configuration.adapter, "or of an external program").must_exist();
  fields.value("set", configuration.set, "overrides of it, key.path: value");
  fields.expect(!configuration.file || !configuration.adapter, "file",
                "must not be stated beside 'adapter'");
  expect_no_seed(fields, "set", configuration.set);
  fields.value("datasets", configuration.datasets, "names of those it runs over; default: all");
  fields.value("seeds", configuration.seeds, "default: the sweep's");
  fields.value("repeat", configuration.repeat, "repetitions; default: the sweep's")
      .range(1, 100000);
  fields.value("from", configuration.from, "configuration before it whose run it starts from");
  fields.value("poses_from", configuration.poses_from, "or takes the poses of");
  fields.value("depth_from", configuration.depth_from, "or the depth");
  if (!fields.reading() || !configuration.name.empty()) return;
  configuration.name = "defaults";
  if (configuration.file) configuration.name = configuration.file->stem();
  if (configuration.adapter) configuration.name = configuration.adapter->stem();
  if (!configuration.module.empty() && !configuration.adapter)
    configuration.name = configuration.module + " " + configuration.name;
}

void describe(config::Fields& fields, ExpectedMetric& figure) {
  fields.value("configuration", figure.configuration, "its name").required();
  fields.value("datasets", figure.datasets, "default: all that it runs over");
  fields.value("metric", figure.metric, "key of metrics.json").required();
  fields.value("at_most", figure.at_most, "of the mean over the seeds, of a speed the median");
  fields.value("at_least", figure.at_least, "the same");
  fields.expect(figure.at_most || figure.at_least, "metric", "needs 'at_most' or 'at_least'");
}

void describe(config::Fields& fields, SweepVariant& variant) {
  fields.value("name", variant.name, "in tables").required();
  fields.value("set", variant.set, "overrides of the configuration, key.path: value");
  fields.expect(!variant.name.empty(), "name", "must not be empty");
  expect_no_seed(fields, "set", variant.set);
}

void describe(config::Fields& fields, SweepConfig& sweep) {
  fields.value("title", sweep.title, "of sweep.md");
  fields.value("module", sweep.module, "what `saccade run` runs");
  fields.section("generate", sweep.generate, "many datasets from ranges, in place of 'datasets'");
  config::Rule datasets =
      fields.list("datasets", sweep.datasets, "each {path} or {simulate, set, seeds}");
  if (!sweep.generate) datasets.required().length(1, config::Rule::kAnyLength);
  fields.list("configurations", sweep.configurations,
              "each {name, module, file or adapter, set, datasets, from}");
  fields.list("variants", sweep.variants, "each {name, set}");
  fields.value("grid", sweep.grid, "key.path: list of values; every combination is run");
  fields.value("seeds", sweep.seeds, "of the runs");
  fields.value("repeat", sweep.repeat, "repetitions of each run, for its speed").range(1, 100000);
  fields.value("timing", sweep.timing, "one run at a time on one thread, for a speed to quote");
  fields.value("threads", sweep.threads, "of one run or generated dataset").range(1, 4096);
  fields.value("cache", sweep.cache, "simulate into the cache that all sweeps share");
  fields.value("start_s", sweep.start_s, "begin of the window; default: first event");
  fields.value("duration_s", sweep.duration_s, "length of the window").above(0);
  fields.value("metrics", sweep.metrics, "of metrics.json in sweep.md; default: the usual ones");
  fields.section("slurm", sweep.slurm, "what --launcher slurm asks for each job");
  fields.list("expected", sweep.expected,
              "each {configuration, datasets, metric, at_most, at_least}");
  expect_names_differ(fields, "datasets", sweep.datasets);
  expect_names_differ(fields, "configurations", sweep.configurations);
  expect_names_differ(fields, "variants", sweep.variants);
  expect_seeds_differ(fields, sweep.seeds);
  expect_no_seed(fields, "grid", sweep.grid);
  fields.expect(!sweep.timing || sweep.threads == 1, "threads", "must be 1 where 'timing' is true");
  const bool generates = sweep.generate.has_value();
  fields.expect(!generates || sweep.datasets.empty(), "generate", "takes the place of 'datasets'");
  fields.expect(!generates || sweep.configurations.empty(), "generate",
                "makes datasets and runs nothing over them; name them by 'path' in another sweep");
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
  check_configurations(fields, sweep);
  check_expected(fields, sweep);
}

}  // namespace saccade
