#include "eval/view/view_session.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/io/run/path_so_far.h"
#include "core/version.h"
#include "eval/report/charts/page_data.h"
#include "eval/report/html.h"
#include "eval/report/run_data.h"
#include "eval/view/assets.h"
#include "eval/view/view_drawings.h"
#include "eval/view/view_query.h"
#include "eval/view/view_summary.h"

namespace saccade {
namespace {

constexpr const char* kJson = "application/json";
constexpr const char* kBinary = "application/octet-stream";
constexpr int kRateBins = 240;
// So that no sum of two overflows: some thousand years [us].
constexpr std::int64_t kFarthest_us = std::int64_t{1} << 56;

const ViewRecording& recording_of(ViewQuery& query, const ViewContent& content) {
  return *content.recordings[query.index("recording", content.recordings.size())];
}

const ViewRun& run_of(ViewQuery& query, const ViewContent& content) {
  return content.runs[query.index("run", content.runs.size())];
}

ViewAnswer picture_answer(ViewPicture&& picture) {
  return {200, std::move(picture.type), std::move(picture.bytes)};
}

ViewSpan span_of(ViewQuery& query) {
  ViewSpan span;
  span.start_us = query.number("start_us", -kFarthest_us, kFarthest_us);
  span.end_us = query.number("end_us", span.start_us,
                             std::min(kFarthest_us, span.start_us + kLongestPacked_us));
  return span;
}

ViewAnswer events_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  const ViewSpan span = span_of(query);
  const std::int64_t every = query.number_or("every", 1, 1'000'000'000, 1);
  query.expect_all_read();
  if (!recording.events) throw BadRequest(404, "the recording holds no events");
  return {200, kBinary,
          pack_events(*recording.events, span.start_us, span.end_us,
                      static_cast<std::uint64_t>(every))};
}

ViewAnswer rate_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  query.expect_all_read();
  return {200, kJson, event_rate_json(recording, kRateBins)};
}

ViewAnswer frame_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  const std::size_t id = query.index("id", recording.dataset.frames().size());
  query.expect_all_read();
  return picture_answer(frame_picture(recording, id));
}

ViewAnswer depth_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  const std::size_t id = query.index("id", recording.dataset.depth_maps().size());
  query.expect_all_read();
  return picture_answer(depth_picture(recording, id));
}

ViewAnswer run_depth_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRun& run = run_of(query, content);
  const std::size_t id = query.index("id", run.views.size());
  query.expect_all_read();
  if (!run.recording || run.views[id].depth.empty())
    throw BadRequest(404, "there is no depth of this view");
  return picture_answer(run_depth_picture(run, *content.recordings[*run.recording], id));
}

ViewAnswer run_image_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRun& run = run_of(query, content);
  const std::size_t id = query.index("id", run.views.size());
  query.expect_all_read();
  if (run.views[id].image.empty()) throw BadRequest(404, "there is no image of this view");
  return picture_answer(run_image_picture(run, id));
}

ViewAnswer path_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  query.expect_all_read();
  return {200, kJson, path_json(recording.dataset.groundtruth())};
}

ViewAnswer run_path_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRun& run = run_of(query, content);
  query.expect_all_read();
  return {200, kJson, path_json(run.aligned_path())};
}

ViewAnswer cloud_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRecording& recording = recording_of(query, content);
  query.expect_all_read();
  return {200, kBinary, recording_cloud(recording)};
}

ViewAnswer run_cloud_answer(ViewQuery& query, const ViewContent& content) {
  const ViewRun& run = run_of(query, content);
  query.expect_all_read();
  return {200, kBinary, run_cloud(run)};
}

ViewAnswer live_events_answer(ViewQuery& query, const ViewContent& content) {
  const ViewUnfinished& unfinished =
      content.unfinished[query.index("unfinished", content.unfinished.size())];
  const ViewSpan span = span_of(query);
  query.expect_all_read();
  if (!unfinished.events) throw BadRequest(404, "its events cannot be read yet");
  return {200, kBinary, unfinished.events->pack(span.start_us, span.end_us)};
}

ViewAnswer live_frame_answer(ViewQuery& query, const ViewContent& content) {
  const ViewUnfinished& unfinished =
      content.unfinished[query.index("unfinished", content.unfinished.size())];
  const std::size_t id = query.index("id", unfinished.frames());
  query.expect_all_read();
  return picture_answer(stored_picture(unfinished.frame(id)));
}

ViewAnswer live_path_answer(ViewQuery& query, const ViewContent& content) {
  const ViewUnfinished& unfinished =
      content.unfinished[query.index("unfinished", content.unfinished.size())];
  query.expect_all_read();
  const auto shown = read_path_so_far(unfinished.hidden);
  if (!shown) throw BadRequest(404, "it shows no path");
  return {200, kJson, path_json(shown->path)};
}

ViewAnswer errors_answer(ViewQuery& query, const ViewContent& content) {
  const std::size_t index = query.index("run", content.runs.size());
  query.expect_all_read();
  const RunData data = gather_errors(content.runs[index].run.folder, index);
  return {200, kJson, data.samples.t_s.empty() ? "null" : run_page_data(data)};
}

using Answer = ViewAnswer (*)(ViewQuery&, const ViewContent&);
constexpr std::array<std::pair<const char*, Answer>, 14> kAnswers{
    {{"events", events_answer},
     {"live_events", live_events_answer},
     {"live_frame", live_frame_answer},
     {"live_path", live_path_answer},
     {"rate", rate_answer},
     {"frame", frame_answer},
     {"depth", depth_answer},
     {"run_depth", run_depth_answer},
     {"run_image", run_image_answer},
     {"path", path_answer},
     {"run_path", run_path_answer},
     {"cloud", cloud_answer},
     {"run_cloud", run_cloud_answer},
     {"errors", errors_answer}}};

ViewAnswer find_answer(ViewQuery& query, const ViewContent& content) {
  if (query.name() == "sources") {
    query.expect_all_read();
    return {200, kJson, view_summary(content)};
  }
  for (const auto& [name, answer] : kAnswers)
    if (query.name() == name) return answer(query, content);
  throw BadRequest(404, "there is nothing of this name");
}

std::string title_of(const ViewContent& content) {
  if (!content.runs.empty()) return content.runs.front().name;
  if (!content.recordings.empty()) return content.recordings.front()->dataset.facts().name;
  return content.unfinished.front().folder.filename().string();
}

}  // namespace

ViewSession::ViewSession(std::vector<std::filesystem::path> paths, EventTailOf tail_of)
    : paths_(std::move(paths)),
      tail_of_(std::move(tail_of)),
      content_(std::make_shared<const ViewContent>(ViewContent::open(paths_, tail_of_))) {}

std::shared_ptr<const ViewContent> ViewSession::content() const {
  const std::lock_guard lock(mutex_);
  return content_;
}

/// Opens everything anew once a folder that was being written has its name, or is gone, and when a
/// run shows its first path.
void ViewSession::look_for_finished() {
  const std::lock_guard lock(mutex_);
  const auto& unfinished = content_->unfinished;
  const bool changed =
      std::any_of(unfinished.begin(), unfinished.end(), [](const ViewUnfinished& folder) {
        return std::filesystem::exists(folder.folder) || !std::filesystem::exists(folder.hidden) ||
               (!folder.recording && folder.shown_dataset());
      });
  if (changed) content_ = std::make_shared<const ViewContent>(ViewContent::open(paths_, tail_of_));
}

ViewAnswer ViewSession::answer(std::string_view target) {
  try {
    if (target.empty()) return {200, "text/html; charset=utf-8", view_page(title_of(*content()))};
    ViewQuery query = ViewQuery::parse(target);
    if (query.name() == "sources") look_for_finished();
    return find_answer(query, *content());
  } catch (const BadRequest& refusal) {
    return {refusal.status(), "text/plain; charset=utf-8", refusal.what()};
  } catch (const InputError& error) {
    return {422, "text/plain; charset=utf-8", error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return {422, "text/plain; charset=utf-8", error.what()};
  }
}

std::string view_page(const std::string& title, const std::string& clip) {
  return fill_page(assets::view_page_html, {{"title", escape_html(title)},
                                            {"style", std::string(assets::view_css)},
                                            {"clip", clip},
                                            {"script", std::string(assets::view_js)},
                                            {"version", std::string(version())}});
}

}  // namespace saccade
