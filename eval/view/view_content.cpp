#include "eval/view/view_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/io/run/path_so_far.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The sibling where a program writes `folder` until it is complete (ResumableFolder,
/// AtomicFolder); the newest, empty where there is none.
fs::path hidden_sibling(const fs::path& folder) {
  const fs::path whole = named_folder(folder);
  const std::string begin = "." + whole.filename().string() + ".";
  std::error_code error;
  fs::path newest;
  for (const fs::directory_entry& entry : fs::directory_iterator(whole.parent_path(), error)) {
    const std::string name = entry.path().filename().string();
    const bool is_growing = name == begin + "unfinished" || name.starts_with(begin + "partial-");
    if (!is_growing || !entry.is_directory(error)) continue;
    if (newest.empty() || entry.last_write_time(error) > fs::last_write_time(newest, error))
      newest = entry.path();
  }
  return newest;
}

/// Index of the recording of `folder`, which is opened where it is the first time.
std::size_t recording_of(const fs::path& folder, ViewContent& content) {
  const fs::path whole = fs::weakly_canonical(folder);
  auto& all = content.recordings;
  const auto known = std::find_if(all.begin(), all.end(), [&](const auto& recording) {
    return fs::weakly_canonical(recording->folder) == whole;
  });
  const auto index = static_cast<std::size_t>(known - all.begin());
  if (known == all.end()) all.push_back(std::make_unique<ViewRecording>(folder));
  return index;
}

void add_run(const fs::path& folder, ViewContent& content) {
  ViewRun run{"", RunFolder::open(folder), {}, {}, {}, false};
  run.name = run.run.name();
  if (fs::exists(folder / "views.yaml")) run.views = read_view_list(folder / "views.yaml");
  if (fs::is_directory(run.run.record.dataset))
    run.recording = recording_of(run.run.record.dataset, content);
  if (run.recording) {
    const TrajectoryScoreInput input =
        score_input(run.run, content.recordings[*run.recording]->dataset);
    run.truth_from_estimate = truth_from_estimate(input);
    run.is_aligned = input.freedom != Alignment::kNone && !associate(input).empty();
  }
  content.runs.push_back(std::move(run));
}

void add_missing(const fs::path& path, const EventTailOf& tail_of, ViewContent& content) {
  const fs::path hidden = hidden_sibling(path);
  if (hidden.empty())
    throw InputError(path.string(),
                     "no such folder; name a dataset or a run, or one that a program is writing");
  ViewUnfinished unfinished{path, hidden, nullptr, {}};
  if (const auto dataset = unfinished.shown_dataset())
    unfinished.recording = recording_of(*dataset, content);
  else if (tail_of)
    unfinished.events = std::make_shared<UnfinishedEvents>(tail_of(hidden));
  content.unfinished.push_back(std::move(unfinished));
}

void add(const fs::path& path, const EventTailOf& tail_of, ViewContent& content) {
  if (!fs::exists(path)) return add_missing(path, tail_of, content);
  if (!fs::is_directory(path))
    throw InputError(path.string(),
                     "is a file; name the folder of a dataset or a run (saccade convert makes a "
                     "dataset of a recording)");
  if (fs::exists(path / "run.yaml")) return add_run(path, content);
  const bool is_dataset = fs::exists(path / "calib.txt") || fs::exists(path / "camera.yaml") ||
                          fs::exists(path / "dataset.yaml");
  if (!is_dataset)
    throw InputError(path.string(),
                     "is neither a dataset nor a run: it holds no run.yaml, dataset.yaml, "
                     "calib.txt or camera.yaml");
  static_cast<void>(recording_of(path, content));
}

void tell_names_apart(std::vector<ViewRun>& runs) {
  std::multiset<std::string> names;
  for (const ViewRun& run : runs) names.insert(run.name);
  for (ViewRun& run : runs)
    if (names.count(run.name) > 1) run.name = run.run.folder.string();
}

}  // namespace

Trajectory ViewRun::aligned_path() const {
  return run.trajectory ? truth_from_estimate * *run.trajectory : Trajectory();
}

ViewRecording::ViewRecording(const fs::path& path) : folder(path), dataset(Dataset::open(path)) {
  if (!dataset.events_file().empty())
    events.emplace(dataset.events_file(),
                   SensorSize{dataset.camera().width, dataset.camera().height});
  const auto first = dataset.depth_maps().begin();
  if (first != dataset.depth_maps().end() && fs::exists(first->file))
    depth_range = saccade::depth_range(dataset.load_depth(0));
}

std::optional<fs::path> ViewUnfinished::shown_dataset() const {
  const auto shown = read_path_so_far(hidden);
  if (!shown || !fs::is_directory(shown->dataset)) return std::nullopt;
  return shown->dataset;
}

std::size_t ViewUnfinished::frames() const {
  std::size_t count = 0;
  while (fs::exists(frame(count))) ++count;
  return count;
}

fs::path ViewUnfinished::frame(std::size_t index) const {
  return hidden / "content/images" / fmt::format("frame_{:08}.png", index);
}

ViewContent ViewContent::open(std::span<const fs::path> paths, const EventTailOf& tail_of) {
  ViewContent content;
  std::set<fs::path> seen;
  for (const fs::path& path : paths)
    if (seen.insert(fs::weakly_canonical(path)).second) add(path, tail_of, content);
  tell_names_apart(content.runs);
  return content;
}

}  // namespace saccade
