#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "eval/view/view_content.h"

namespace saccade {

/// An answer of HTTP.
struct ViewAnswer {
  int status = 200;
  std::string type;  ///< MIME
  std::string body;
};

/// Answers what the page of `saccade view` asks. Thread-safe. All that is asked for is a name of
/// a fixed list with whole numbers, so no request can name a file:
///   ""                                              the page
///   sources                                         view_summary(), and what appeared since
///   events?recording=&start_us=&end_us=[&every=]    pack_events()
///   rate?recording=                                 event_rate_json()
///   frame?recording=&id=  depth?recording=&id=      a picture
///   run_depth?run=&id=    run_image?run=&id=        a picture
///   path?recording=  run_path?run=                  path_json(), of the truth and of a run
///   cloud?recording=  run_cloud?run=                points in the world
///   live_events?unfinished=&start_us=&end_us=       UnfinishedEvents::pack()
///   live_frame?unfinished=&id=                      a picture
///   live_path?unfinished=                           path_json(), of a run that shows its path
///   errors?run=                                     run_page_data() of the report; null without a truth
/// What is asked wrongly is answered by 400 or 404 and a sentence, what the files do not yield (they
/// are damaged, or gone) by 422 and the error.
class ViewSession {
 public:
  /// InputError for a path that is neither dataset nor run.
  /// `tail_of`: reads the events of what is being written; may be empty.
  explicit ViewSession(std::vector<std::filesystem::path> paths, EventTailOf tail_of = {});

  /// `target`: what follows the token in a request's target.
  [[nodiscard]] ViewAnswer answer(std::string_view target);

  [[nodiscard]] std::shared_ptr<const ViewContent> content() const;

 private:
  void look_for_finished();

  std::vector<std::filesystem::path> paths_;
  EventTailOf tail_of_;
  mutable std::mutex mutex_;  ///< of content_
  std::shared_ptr<const ViewContent> content_;
};

/// The page without a clip: it asks for what it shows.
[[nodiscard]] std::string view_page(const std::string& title, const std::string& clip = "null");

}  // namespace saccade
