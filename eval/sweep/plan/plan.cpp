#include "eval/sweep/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string_view>

#include "core/check.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// A text as part of a file name: other characters become single dashes.
std::string file_name_part(std::string_view text) {
  std::string part = text.starts_with('-') ? "-" : "";  // the sign of a number
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("._+").find(c) != std::string_view::npos;
    if (plain)
      part += c;
    else if (!part.empty() && part.back() != '-')
      part += '-';
  }
  while (part.ends_with('-')) part.pop_back();
  if (part.empty()) return "_";
  return part.starts_with('.') ? "_" + part : part;
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// "samples" of "align.samples"; the whole key where two axes end in the same word.
std::string short_key(const std::string& key, const Grid& grid) {
  const auto has_same_end = [&](const GridAxis& axis) {
    return last_part(axis.key) == last_part(key);
  };
  return std::count_if(grid.begin(), grid.end(), has_same_end) > 1 ? key : last_part(key);
}

/// Makes names unique, ignoring upper and lower case.
class UniqueNames {
 public:
  std::string unique(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !taken_.insert(folded(name)).second; ++i)
      name = fmt::format("{}.{}", wanted, i);
    return name;
  }

 private:
  static std::string folded(std::string name) {
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name;
  }

  std::set<std::string> taken_;
};

void append(Words& words, const Settings& settings) {
  for (const Setting& setting : settings)
    words.insert(words.end(), {"--set", setting.key + "=" + setting.value});
}

void append(Words& words, const char* option, const std::string& value) {
  words.insert(words.end(), {option, value});
}

void append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
}

/// Independent of the working directory, so that a job is recognised in later calls.
fs::path fixed_path(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

/// The seeds, or one nullopt: the seed that the file states.
std::vector<std::optional<std::uint64_t>> seeds_or_default(
    const std::vector<std::uint64_t>& seeds) {
  if (seeds.empty()) return {std::nullopt};
  return {seeds.begin(), seeds.end()};
}

/// Every combination of the values; the last axis changes fastest. One empty combination without
/// axes.
std::vector<std::vector<std::string>> combinations(const Grid& grid) {
  std::vector<std::vector<std::string>> all{{}};
  for (const GridAxis& axis : grid) {
    std::vector<std::vector<std::string>> longer;
    for (const std::vector<std::string>& begin : all)
      for (const std::string& value : axis.values) {
        longer.push_back(begin);
        longer.back().push_back(value);
      }
    all = std::move(longer);
  }
  return all;
}

/// The first values of all axes, then every other value of each axis beside the first ones.
std::vector<std::vector<std::string>> one_at_a_time(const Grid& grid) {
  std::vector<std::string> base;
  for (const GridAxis& axis : grid) base.push_back(axis.values.front());
  std::vector<std::vector<std::string>> all{base};
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (std::size_t k = 1; k < grid[i].values.size(); ++k) {
      all.push_back(base);
      all.back()[i] = grid[i].values[k];
    }
  return all;
}

std::vector<std::vector<std::string>> points_of(const SweepConfig& sweep) {
  return sweep.plan == GridPlan::kOneAtATime ? one_at_a_time(sweep.grid) : combinations(sweep.grid);
}

class Planner {
 public:
  Planner(const SweepConfig& sweep, const fs::path& folder) : sweep_(sweep), folder_(folder) {
    for (const GridAxis& axis : sweep.grid) plan_.axes.push_back(axis.key);
  }

  SweepPlan plan() {
    if (sweep_.generate) add_generated(*sweep_.generate);
    for (const SweepDataset& dataset : sweep_.datasets)
      for (const auto& seed : seeds_or_default(seeds_of(dataset))) {
        SweepJob base = dataset_job(dataset, seed);
        if (!sweep_.configurations.empty()) add_runs(base, 0);
      }
    return std::move(plan_);
  }

 private:
  /// What events may be scored against.
  struct Truth {
    SweepPoint point;
    fs::path folder;
    std::optional<std::size_t> made_by;
  };

  /// Of an external simulator those of the dataset that it works from.
  [[nodiscard]] const std::vector<std::uint64_t>& seeds_of(const SweepDataset& dataset) const {
    if (!dataset.adapter) return dataset.seeds;
    const auto truth =
        std::find_if(sweep_.datasets.begin(), sweep_.datasets.end(),
                     [&](const SweepDataset& other) { return other.name == dataset.against; });
    SACCADE_CHECK(truth != sweep_.datasets.end());
    return truth->seeds;
  }

  /// Adds the job that makes the dataset, if any does. Returns the common part of the runs over it.
  SweepJob dataset_job(const SweepDataset& dataset, const std::optional<std::uint64_t>& seed) {
    SweepJob base;
    base.point.dataset = dataset.name;
    base.point.dataset_seed = seed;
    base.name = file_name_part(dataset.name);
    if (seed && seeds_of(dataset).size() > 1) base.name += fmt::format("-{}", *seed);
    if (dataset.path) {
      base.dataset = fixed_path(*dataset.path);
      truths_.push_back({base.point, base.dataset, std::nullopt});
      return base;
    }
    SweepJob job = base;
    job.name = names_.unique(base.name);
    job.output = folder_ / "data" / job.name;
    if (!dataset.against.empty()) set_truth(job, dataset.against);
    if (dataset.adapter)
      run_simulator(job, dataset);
    else
      simulate(job, dataset);
    if (!dataset.against.empty()) score_events(job);
    base.dataset = job.output;
    base.made_by = plan_.simulations.size();
    plan_.simulations.push_back(std::move(job));
    truths_.push_back({base.point, base.dataset, base.made_by});
    return base;
  }

  static void simulate(SweepJob& job, const SweepDataset& dataset) {
    job.config = fixed_path(*dataset.simulate);
    Words settings;
    append(settings, dataset.set);
    if (job.point.dataset_seed) append(settings, "--seed", std::to_string(*job.point.dataset_seed));
    Words call{"simulate", job.config.string(), "-o", job.output.string(), "--cached"};
    append(call, settings);
    job.commands = {call};
    job.settings = "simulate " + shell_line(settings);
  }

  /// An external simulator works from the dataset that its events are scored against.
  void run_simulator(SweepJob& job, const SweepDataset& dataset) const {
    job.config = fixed_path(*dataset.adapter);
    job.makes_run = true;
    Words settings;
    append(settings, dataset.set);
    append(settings, "--threads", std::to_string(sweep_.threads));
    Words call{"run", "external",          "--data", job.dataset.string(),
               "-o",  job.output.string(), "-c",     job.config.string()};
    append(call, settings);
    job.commands = {call};
    job.settings = "run external " + shell_line(settings);
  }

  /// The events of the dataset of this name, of the same seed where it has several.
  void set_truth(SweepJob& job, const std::string& name) {
    const Truth* found = nullptr;
    for (const Truth& truth : truths_)
      if (truth.point.dataset == name &&
          (found == nullptr || truth.point.dataset_seed == job.point.dataset_seed))
        found = &truth;
    SACCADE_CHECK(found != nullptr);
    job.dataset = found->folder;
    job.made_by = found->made_by;
    if (found->made_by) job.stage = plan_.simulations[*found->made_by].stage + 1;
  }

  void score_events(SweepJob& job) const {
    const fs::path folder = folder_ / "scores" / job.name;
    const fs::path events = job.makes_run ? job.output / "events.h5" : job.output;
    job.scores = folder / "metrics.json";
    job.commands.push_back({"eval", "--events", events.string(), "--against", job.dataset.string(),
                            "-o", folder.string()});
  }

  /// Generated datasets go to the folder of the sweep and not into the cache: other sweeps do not
  /// reuse them.
  void add_generated(const GenerateConfig& generate) {
    for (int i = 0; i < generate.count; ++i) {
      const GeneratedDataset dataset =
          generated_dataset(generate, generate.first + static_cast<std::uint64_t>(i));
      SweepJob job;
      job.point.dataset = dataset.name;
      job.point.dataset_seed = dataset.seed;
      job.name = file_name_part(dataset.name);
      job.config = fixed_path(dataset.scene->simulate);
      job.output = folder_ / "data";
      if (generate.shards > 1) job.output /= fmt::format("shard-{:02}", dataset.shard);
      job.output /= job.name;
      Words settings;
      append(settings, dataset.settings);
      append(settings, "--seed", std::to_string(dataset.seed));
      job.settings = "simulate " + shell_line(settings);
      Words call{"simulate", job.config.string(), "-o", job.output.string()};
      append(call, "--threads", std::to_string(sweep_.threads));
      append(call, settings);
      job.commands = {call};
      SweepJob base;
      base.name = job.name;
      base.point = job.point;
      base.point.dataset = dataset.scene->name;
      base.point.is_generated = true;
      base.dataset = job.output;
      base.made_by = plan_.simulations.size();
      plan_.simulations.push_back(std::move(job));
      if (!sweep_.configurations.empty()) add_runs(base, dataset.index);
    }
  }

  /// `index`: of a generated dataset.
  void add_runs(const SweepJob& base, std::uint64_t index) {
    std::vector<SweepVariant> variants = sweep_.variants;
    if (variants.empty()) variants.emplace_back();
    for (const SweepConfiguration& configuration : sweep_.configurations) {
      if (!configuration.runs_over(base.point.dataset) ||
          index % static_cast<std::uint64_t>(configuration.every) != 0)
        continue;
      for (const SweepVariant& variant : variants)
        for (const std::vector<std::string>& values : points_of(sweep_))
          for (const auto& seed : seeds_or_default(sweep_.seeds_of(configuration))) {
            SweepJob job = base;
            job.point.module = module_of(configuration);
            job.point.configuration = configuration.name;
            job.point.variant = variant.name;
            job.point.grid = values;
            job.point.seed = seed;
            finish_run(job, configuration, variant);
            plan_.runs.push_back(std::move(job));
          }
    }
  }

  [[nodiscard]] const std::string& module_of(const SweepConfiguration& configuration) const {
    return configuration.module.empty() ? sweep_.module : configuration.module;
  }

  /// Passes the run of another configuration at the same point to the job.
  void add_source(const std::string& configuration, const char* option, SweepJob& job,
                  Words& call) {
    if (configuration.empty()) return;
    const auto is_source = [&](const SweepJob& run) {
      return run.point.configuration == configuration && run.dataset == job.dataset &&
             run.point.variant == job.point.variant && run.point.grid == job.point.grid &&
             run.point.seed == job.point.seed;
    };
    // From the end: it was added not long ago, and a sweep may have ten thousand runs.
    const auto last = std::find_if(plan_.runs.rbegin(), plan_.runs.rend(), is_source);
    SACCADE_CHECK(last != plan_.runs.rend());
    const auto found = std::prev(last.base());
    append(call, option, found->output.string());
    job.sources.push_back(static_cast<std::size_t>(found - plan_.runs.begin()));
    job.source_runs.push_back(found->output);
    job.stage = std::max(job.stage, found->stage + 1);
  }

  void finish_run(SweepJob& job, const SweepConfiguration& configuration,
                  const SweepVariant& variant) {
    job.name = names_.unique(run_name(job));
    job.output = folder_ / "runs" / job.name;
    job.scores = job.output / "metrics.json";
    job.makes_run = true;
    if (configuration.file) job.config = fixed_path(*configuration.file);
    if (configuration.adapter) job.config = fixed_path(*configuration.adapter);
    Words settings;
    append(settings, configuration.set);
    append(settings, variant.set);
    for (std::size_t i = 0; i < sweep_.grid.size(); ++i)
      append(settings, "--set", sweep_.grid[i].key + "=" + job.point.grid[i]);
    if (job.point.seed) append(settings, "--seed", std::to_string(*job.point.seed));
    if (sweep_.duration_s) append(settings, "--duration-s", fmt::format("{}", *sweep_.duration_s));
    append(settings, "--repeat", std::to_string(configuration.repeat.value_or(sweep_.repeat)));
    append(settings, "--threads", std::to_string(sweep_.threads));
    const std::string called = configuration.adapter ? "external" : job.point.module;
    Words call{"run", called, "--data", job.dataset.string(), "-o", job.output.string()};
    if (!job.config.empty()) append(call, "-c", job.config.string());
    add_source(configuration.from, "--from", job, call);
    add_source(configuration.poses_from, "--poses-from", job, call);
    add_source(configuration.depth_from, "--depth-from", job, call);
    append(call, settings);
    job.commands = {call,
                    {"eval", job.output.string(), "--threads", std::to_string(sweep_.threads)}};
    job.settings = "run " + called + " " + shell_line(settings);
  }

  [[nodiscard]] std::string run_name(const SweepJob& job) const {
    std::string name = job.name + "_" + file_name_part(job.point.configuration);
    if (!job.point.variant.empty()) name += "_" + file_name_part(job.point.variant);
    for (std::size_t i = 0; i < sweep_.grid.size(); ++i)
      name += fmt::format("_{}-{}", file_name_part(short_key(sweep_.grid[i].key, sweep_.grid)),
                          file_name_part(job.point.grid[i]));
    if (job.point.seed) name += fmt::format("_seed-{}", *job.point.seed);
    constexpr std::size_t kMaxLength = 200;  // file systems permit 255 bytes
    return name.substr(0, kMaxLength);
  }

  const SweepConfig& sweep_;
  fs::path folder_;
  SweepPlan plan_;
  std::vector<Truth> truths_;
  UniqueNames names_;
};

}  // namespace

bool SweepPoint::differs_in_seed_only(const SweepPoint& other) const {
  return dataset == other.dataset && configuration == other.configuration &&
         variant == other.variant && grid == other.grid;
}

int SweepPlan::stages(const std::vector<SweepJob>& jobs) {
  int last = 0;
  for (const SweepJob& job : jobs) last = std::max(last, job.stage);
  return last + 1;
}

SweepPlan plan_sweep(const SweepConfig& sweep, const fs::path& folder) {
  return Planner(sweep, fixed_path(folder)).plan();
}

}  // namespace saccade
