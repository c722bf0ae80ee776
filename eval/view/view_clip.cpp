#include "eval/view/view_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"
#include "eval/view/view_summary.h"

namespace saccade {
namespace {

using Json = nlohmann::json;

std::uint64_t event_count(const ViewContent& content) {
  std::uint64_t count = 0;
  for (const auto& recording : content.recordings)
    if (recording->events) count += recording->events->info().count;
  return count;
}

/// Answers of the session by what the page would ask.
class ClipAnswers {
 public:
  explicit ClipAnswers(ViewSession& session) : session_(session) {}

  /// Nothing where the session refuses: the data has no such thing.
  void add(const std::string& target) {
    const ViewAnswer answer = session_.answer(target);
    if (answer.status == 200)
      answers_[target] = {{"type", answer.type}, {"base64", base64(answer.body)}};
  }

  void add_text(const std::string& target, const std::string& text) {
    answers_[target] = {{"type", "application/json"}, {"base64", base64(text)}};
  }

  void add_pictures(const char* name, const char* owner, std::size_t index, const Json& of,
                    const char* list) {
    if (!of.contains(list)) return;
    for (const Json& id : of[list]["id"])
      add(fmt::format("{}?{}={}&id={}", name, owner, index, id.get<std::size_t>()));
  }

  [[nodiscard]] const Json& json() const { return answers_; }

 private:
  ViewSession& session_;
  Json answers_ = Json::object();
};

void add_recording(ClipAnswers& answers, std::size_t i, const Json& recording,
                   std::uint64_t every) {
  for (const char* name : {"rate", "path", "cloud"})
    answers.add(fmt::format("{}?recording={}", name, i));
  answers.add_pictures("frame", "recording", i, recording, "frames");
  answers.add_pictures("depth", "recording", i, recording, "depth");
  if (!recording.contains("events")) return;
  const auto end = recording["end_us"].get<std::int64_t>();
  const auto slot = recording["slot_us"].get<std::int64_t>();
  for (auto start = recording["start_us"].get<std::int64_t>(); start < end; start += slot)
    answers.add(fmt::format("events?recording={}&start_us={}&end_us={}&every={}", i, start,
                            std::min(start + slot, end), every));
}

void add_run(ClipAnswers& answers, std::size_t i, const Json& run) {
  for (const char* name : {"run_path", "run_cloud", "errors"})
    answers.add(fmt::format("{}?run={}", name, i));
  answers.add_pictures("run_depth", "run", i, run, "depth");
  answers.add_pictures("run_image", "run", i, run, "image");
}

bool has_left_out(const Json& of, const char* list) {
  return of.contains(list) && of[list]["id"].size() < of[list]["count"].get<std::size_t>();
}

/// "every 3rd of 2,500,000 events, at most 60 pictures of a kind".
std::string thinning(std::uint64_t count, std::uint64_t every, const Json& sources) {
  std::string text = every == 1 ? fmt::format("all {} events", grouped(static_cast<double>(count)))
                                : fmt::format("1 of every {} of {} events", every,
                                              grouped(static_cast<double>(count)));
  bool is_thinned = false;
  for (const char* owner : {"recordings", "runs"})
    for (const Json& of : sources[owner])
      for (const char* list : {"frames", "depth", "image"})
        is_thinned = is_thinned || has_left_out(of, list);
  if (is_thinned) text += fmt::format(", {} evenly spaced pictures of a kind", kMostClipPictures);
  return text;
}

std::string title_of(const Json& sources) {
  return (sources["runs"].empty() ? sources["recordings"] : sources["runs"])[0]["name"];
}

}  // namespace

std::string write_clip(ViewSession& session, const std::filesystem::path& file) {
  const auto content = session.content();
  if (!content->unfinished.empty())
    throw InputError(content->unfinished.front().folder.string(),
                     "is still being written; export it when it is complete");
  const std::uint64_t count = event_count(*content);
  const std::uint64_t every =
      std::max<std::uint64_t>(1, (count + kMostClipEvents - 1) / kMostClipEvents);
  const std::string text = view_summary(*content, kMostClipPictures);
  const Json sources = Json::parse(text);
  ClipAnswers answers(session);
  answers.add_text("sources", text);
  for (std::size_t i = 0; i < sources["recordings"].size(); ++i)
    add_recording(answers, i, sources["recordings"][i], every);
  for (std::size_t i = 0; i < sources["runs"].size(); ++i) add_run(answers, i, sources["runs"][i]);
  const std::string left = thinning(count, every, sources);
  const Json clip{{"every", every}, {"note", left}, {"answers", answers.json()}};
  write_atomically(
      file, view_page(title_of(sources),
                      inside_script(clip.dump(-1, ' ', false, Json::error_handler_t::replace))));
  return left;
}

}  // namespace saccade
