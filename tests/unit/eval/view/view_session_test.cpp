#include "eval/view/view_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/io/run/path_so_far.h"
#include "eval/view/view_clip.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

class View : public testing::FakeFolders {};

Json sources_of(ViewSession& session) { return Json::parse(session.answer("sources").body); }

std::string error_of_opening(const fs::path& path) {
  try {
    const ViewSession session({path});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(View, SaysWhatThereIs) {
  ViewSession session({run(), dataset(), run()});
  const Json sources = sources_of(session);
  ASSERT_EQ(sources["recordings"].size(), 1U) << "the run's dataset is the one that was named";
  const Json& recording = sources["recordings"][0];
  EXPECT_EQ(recording["name"], "walls");
  EXPECT_EQ(recording["width"], 80);
  EXPECT_EQ(recording["truth"], true);
  EXPECT_GT(recording["events"], 1000);
  EXPECT_EQ(recording["frames"]["t"].size(), recording["frames"]["id"].size());
  EXPECT_GT(recording["depth"]["far"], recording["depth"]["near"]);
  ASSERT_EQ(sources["runs"].size(), 1U);
  EXPECT_EQ(sources["runs"][0]["name"], "walls_accurate");
  EXPECT_EQ(sources["runs"][0]["recording"], 0);
  EXPECT_FALSE(sources["runs"][0].contains("depth")) << "the run made none";
}

TEST_F(View, SlotsHoldEveryEventOnce) {
  ViewSession session({dataset()});
  const Json recording = sources_of(session)["recordings"][0];
  const auto end = recording["end_us"].get<std::int64_t>(), slot = std::int64_t{20'000};
  std::size_t bytes = 0, slots = 0;
  for (auto at = recording["start_us"].get<std::int64_t>(); at < end; at += slot, ++slots)
    bytes += session
                 .answer("events?recording=0&start_us=" + std::to_string(at) +
                         "&end_us=" + std::to_string(std::min(at + slot, end)))
                 .body.size();
  EXPECT_EQ(bytes, 8 * slots + 8 * recording["events"].get<std::size_t>());
  const Json rate = Json::parse(session.answer("rate?recording=0").body);
  std::size_t counted = 0;
  for (const Json& count : rate) counted += count.get<std::size_t>();
  EXPECT_EQ(counted, recording["events"].get<std::size_t>());
}

TEST_F(View, GivesPicturesPathsCloudsAndErrors) {
  ViewSession session({run()});
  for (const char* picture : {"frame?recording=0&id=0", "depth?recording=0&id=0"}) {
    const ViewAnswer answer = session.answer(picture);
    EXPECT_EQ(answer.status, 200) << picture;
    EXPECT_EQ(answer.type, "image/png");
    EXPECT_THAT(answer.body, StartsWith("\x89PNG"));
  }
  for (const char* path : {"path?recording=0", "run_path?run=0"}) {
    const Json poses = Json::parse(session.answer(path).body);
    ASSERT_GT(poses["t"].size(), 10U) << path;
    EXPECT_EQ(poses["p"].size(), poses["t"].size());
    EXPECT_EQ(poses["p"][0].size(), 7U);
  }
  for (const char* cloud : {"cloud?recording=0", "run_cloud?run=0"}) {
    const std::string points = session.answer(cloud).body;
    EXPECT_GT(points.size(), 12U * 100) << cloud;
    EXPECT_EQ(points.size() % 12, 0U);
  }
  const Json errors = Json::parse(session.answer("errors?run=0").body);
  EXPECT_TRUE(errors["series"].contains("dt_rel"));
  EXPECT_TRUE(errors["series"].contains("dtheta"));
}

TEST_F(View, RefusesBadRequests) {
  ViewSession session({run()});
  const std::vector<std::pair<const char*, int>> requests{
      {"../../../etc/passwd", 404},
      {"..%2f..%2fetc%2fpasswd", 404},
      {"dataset.yaml", 404},
      {"frame?recording=0&id=../x", 400},
      {"frame?recording=0&id=100000", 404},
      {"frame?recording=1&id=0", 404},
      {"frame?recording=-1&id=0", 404},
      {"frame?id=0", 400},
      {"frame?recording=0&id=0&more=1", 400},
      {"run_depth?run=0&id=0", 404},
      {"events?recording=0&start_us=0", 400},
      {"events?recording=0&start_us=10&end_us=0", 400},
      {"events?recording=0&start_us=0&end_us=9000000000", 400},
      {"events?recording=0&start_us=-9223372036854775808&end_us=0", 400},
      {"events?recording=0&start_us=0&end_us=9223372036854775807", 400},
      {"events?recording=0&start_us=0&end_us=10&every=0", 400},
      {"sources?x=1", 400}};
  for (const auto& [target, status] : requests) {
    const ViewAnswer answer = session.answer(target);
    EXPECT_EQ(answer.status, status) << target;
    EXPECT_THAT(answer.type, StartsWith("text/plain")) << target;
    EXPECT_LT(answer.body.size(), 200U) << target;
  }
}

TEST_F(View, ADamagedFileIsAnAnswer) {
  const fs::path copy = path("damaged");
  fs::copy(dataset(), copy, fs::copy_options::recursive);
  ViewSession session({copy});
  fs::resize_file(copy / "depth/depth_00000001.exr", 100);
  const ViewAnswer answer = session.answer("depth?recording=0&id=1");
  EXPECT_EQ(answer.status, 422);
  EXPECT_THAT(answer.body, HasSubstr("depth_00000001.exr"));
  EXPECT_EQ(session.answer("frame?recording=0&id=1").status, 200);
}

TEST_F(View, NamesAreNoMarkup) {
  const fs::path evil = path("<img src=x onerror=alert(1)><!--");
  fs::copy(run(), evil, fs::copy_options::recursive);
  ViewSession session({evil});
  const std::string page = session.answer("").body;
  EXPECT_THAT(page, AllOf(HasSubstr("<title>&lt;img src=x onerror"), Not(HasSubstr("<img src=x"))));
  const fs::path file = path("evil.html");
  static_cast<void>(write_clip(session, file));
  EXPECT_THAT(testing::read_file(file), Not(HasSubstr("<img src=x")));
}

TEST_F(View, ARecordingWithoutTruthFramesOrDepthIsShown) {
  const fs::path bare = path("bare");
  fs::create_directories(bare);
  for (const char* file : {"events.h5", "camera.yaml", "calib.txt"})
    fs::copy(dataset() / file, bare / file);
  ViewSession session({bare});
  const Json recording = sources_of(session)["recordings"][0];
  EXPECT_EQ(recording["truth"], false);
  EXPECT_FALSE(recording.contains("frames"));
  EXPECT_FALSE(recording.contains("depth"));
  EXPECT_EQ(Json::parse(session.answer("path?recording=0").body)["t"].size(), 0U);
  EXPECT_EQ(session.answer("cloud?recording=0").body, "");
  EXPECT_EQ(session.answer("frame?recording=0&id=0").status, 404);
}

TEST_F(View, OtherFoldersAreErrorsThatSayWhatIsRight) {
  const testing::TemporaryFolder empty;
  EXPECT_THAT(error_of_opening(empty.path()), HasSubstr("is neither a dataset nor a run"));
  EXPECT_THAT(error_of_opening(empty.path() / "none"), HasSubstr("no such folder"));
  EXPECT_THAT(error_of_opening(dataset() / "events.h5"), HasSubstr("saccade convert"));
}

TEST_F(View, AFolderThatIsBeingWrittenIsFollowedUntilItIsComplete) {
  const testing::TemporaryFolder folder;
  const fs::path hidden = folder.path() / ".growing.unfinished";
  fs::create_directories(hidden / "content/images");
  folder.write(".growing.unfinished/content/images/frame_00000000.png", "x");
  ViewSession session({folder.path() / "growing"});
  const Json before = sources_of(session);
  EXPECT_EQ(before["recordings"].size(), 0U);
  ASSERT_EQ(before["unfinished"].size(), 1U);
  EXPECT_EQ(before["unfinished"][0]["frames"], 1);
  EXPECT_THROW(static_cast<void>(write_clip(session, folder.path() / "x.html")), InputError);
  fs::copy(dataset(), folder.path() / "growing", fs::copy_options::recursive);
  fs::remove_all(hidden);
  const Json after = sources_of(session);
  EXPECT_EQ(after["recordings"].size(), 1U);
  EXPECT_EQ(after["unfinished"].size(), 0U);
}

TEST_F(View, NewestEventsOfWhatIsBeingWrittenAreShown) {
  const testing::TemporaryFolder folder;
  fs::create_directories(folder.path() / ".growing.unfinished/content/images");
  TimeNs now = 0;
  ViewSession session({folder.path() / "growing"}, [&](const fs::path& hidden) {
    EXPECT_EQ(hidden.filename(), ".growing.unfinished");
    return [&](Events& events) {
      for (int i = 0; i < 10; ++i, now += 1'000'000) events.push_back({now, 7, 3, 1});
    };
  });
  const Json first = sources_of(session)["unfinished"][0];
  EXPECT_EQ(first["reached_us"], 9000);
  EXPECT_EQ(first["width"], 8);
  EXPECT_EQ(first["height"], 4);
  EXPECT_EQ(sources_of(session)["unfinished"][0]["reached_us"], 19000);
  const ViewAnswer answer = session.answer("live_events?unfinished=0&start_us=5000&end_us=15000");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body.size(), 8U + 8 * 10);
  EXPECT_EQ(session.answer("live_events?unfinished=1&start_us=0&end_us=1").status, 404);
  EXPECT_EQ(session.answer("live_frame?unfinished=0&id=0").status, 404);
  now = 2'000'000;  // it began anew
  EXPECT_EQ(sources_of(session)["unfinished"][0]["reached_us"], 11000);
  EXPECT_EQ(session.answer("live_events?unfinished=0&start_us=0&end_us=20000").body.size(),
            8U + 8 * 10);
}

TEST_F(View, ARunThatIsBeingWrittenShowsItsPathBesideItsDataset) {
  const testing::TemporaryFolder folder;
  const fs::path hidden = folder.path() / ".growing.partial-1";
  fs::create_directories(hidden);
  ViewSession session({folder.path() / "growing"});
  EXPECT_EQ(sources_of(session)["recordings"].size(), 0U) << "it shows nothing yet";
  EXPECT_EQ(session.answer("live_path?unfinished=0").status, 404);

  const std::vector<StampedPose> path{{0.1, Rigid3()}, {0.2, Rigid3()}, {0.3, Rigid3()}};
  PathSoFar(hidden, dataset()).show(std::span(path).first(2));
  Json sources = sources_of(session);
  ASSERT_EQ(sources["recordings"].size(), 1U);
  ASSERT_EQ(sources["unfinished"].size(), 1U);
  EXPECT_EQ(sources["unfinished"][0]["recording"], 0);
  EXPECT_EQ(sources["unfinished"][0]["path_s"], 0.2);
  EXPECT_FALSE(sources["unfinished"][0].contains("reached_us"));

  PathSoFar(hidden, dataset()).show(path);
  sources = sources_of(session);
  EXPECT_EQ(sources["unfinished"][0]["path_s"], 0.3);
  EXPECT_EQ(Json::parse(session.answer("live_path?unfinished=0").body)["t"].size(), 3U);

  fs::copy(run(), folder.path() / "growing", fs::copy_options::recursive);
  fs::remove_all(hidden);
  sources = sources_of(session);
  EXPECT_EQ(sources["unfinished"].size(), 0U);
  EXPECT_EQ(sources["runs"].size(), 1U);
}

TEST_F(View, AClipHoldsWhatThePageAsks) {
  ViewSession session({run()});
  const fs::path file = path("clip.html");
  EXPECT_THAT(write_clip(session, file), HasSubstr("all "));
  const std::string page = testing::read_file(file);
  const std::string open = "<script type=\"application/json\" id=\"clip\">";
  const std::size_t begin = page.find(open) + open.size();
  const Json clip = Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(clip["every"], 1);
  for (const char* target : {"sources", "rate?recording=0", "path?recording=0", "run_path?run=0",
                             "run_cloud?run=0", "errors?run=0", "frame?recording=0&id=0"})
    EXPECT_TRUE(clip["answers"].contains(target)) << target;
  const Json recording = sources_of(session)["recordings"][0];
  EXPECT_TRUE(clip["answers"].contains(
      "events?recording=0&start_us=" + recording["start_us"].dump() + "&end_us=" +
      std::to_string(std::min(
          recording["start_us"].get<std::int64_t>() + recording["slot_us"].get<std::int64_t>(),
          recording["end_us"].get<std::int64_t>())) +
      "&every=1"));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("src=\"http")), Not(HasSubstr("href=\"http"))));
}

}  // namespace
}  // namespace saccade
