// What users get wrong, one case each: the command must end with exit code 2 and say where the
// fault is and what would be right, and must leave nothing under the output's name.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/io/images/image_file.h"
#include "tests/support/command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;

/// A valid plain recording: three events, two poses, a calibration and one camera size.
void write_recording(const TemporaryFolder& folder) {
  folder.write("data/calib.txt", "200 200 15.5 11.5 0 0 0 0 0\n");
  folder.write("data/events.txt", "0.001 1 2 1\n0.002 3 4 0\n0.003 5 6 1\n");
  folder.write("data/groundtruth.txt", "0 0 0 0 0 0 0 1\n1 0.1 0 0 0 0 0 1\n");
  folder.write("data/images.txt", "");
  folder.write("data/camera.yaml",
               "cam0:\n  camera_model: pinhole\n  intrinsics: [200, 200, 15.5, 11.5]\n"
               "  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n"
               "  resolution: [32, 24]\n");
}

/// A valid simulation of one untextured triangle.
std::string simulation_config() {
  return R"(scene:
  meshes:
    - {file: scene.obj}
trajectory:
  source: waypoints
  waypoints: [[0, 0, 0, 0, 0, 0, 0, 1], [0.1, 0.1, 0, 0, 0, 0, 0, 1]]
camera: {width: 32, height: 24, fx: 30, fy: 30, cx: 15.5, cy: 11.5}
)";
}

void write_simulation(const TemporaryFolder& folder) {
  folder.write("scene.obj", "v -1 -1 2\nv 1 -1 2\nv 0 1 2\nf 1 2 3\n");
  folder.write("simulation.yaml", simulation_config());
}

struct Case {
  std::string name;
  std::function<void(const TemporaryFolder&)> spoil;  ///< on top of the valid files
  std::vector<std::string> arguments;                 ///< "@" stands for the test's folder
  std::vector<std::string> says;                      ///< all of it, somewhere in the output
};

void PrintTo(const Case& wrong, std::ostream* stream) { *stream << wrong.name; }

std::string at(std::string argument, const fs::path& folder) {
  for (std::size_t i = 0; (i = argument.find('@', i)) != std::string::npos;)
    argument.replace(i, 1, folder.string());
  return argument;
}

std::vector<std::string> simulate(std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"simulate", "@/simulation.yaml", "-o", "@/out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> track(std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"run", "track", "--data", "@/data",
                                        "-o",  "@/out", "--set",  "reference.planar_depth_m=1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> overlay(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"render", "@/data", "-o", "@/out.png"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

auto file(const std::string& name, const std::string& text) {
  return [=](const TemporaryFolder& folder) { folder.write(name, text); };
}

auto config_line(const std::string& line) {
  return file("simulation.yaml", simulation_config() + line + "\n");
}

void nothing(const TemporaryFolder&) {}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"UnknownVerb", nothing, {"simulat"}, {"simulat", "simulate"}},
      {"UnknownOption", nothing, simulate({"--thread", "2"}), {"--thread", "--threads"}},
      {"NoConfigFile", nothing, {"simulate", "@/none.yaml", "-o", "@/out"}, {"none.yaml"}},
      {"UnknownKey",
       config_line("evnts: {}"),
       simulate(),
       {"simulation.yaml:8", "evnts", "events"}},
      {"UnknownNestedKey",
       config_line("events:\n  contrast_no: 0.2"),
       simulate(),
       {"simulation.yaml:9", "contrast_no", "contrast_on"}},
      {"WrongType", config_line("seed: abc"), simulate(), {"simulation.yaml:8", "seed", "abc"}},
      {"OutOfRange",
       config_line("events: {contrast_on: -1}"),
       simulate(),
       {"simulation.yaml:8", "contrast_on", "-1"}},
      {"NotYaml", config_line("events: {contrast_on: 1"), simulate(), {"simulation.yaml"}},
      {"DuplicateKey",
       config_line("camera: {width: 10}"),
       simulate(),
       {"simulation.yaml:8", "camera"}},
      {"BadOverride", nothing, simulate({"--set", "camera.widht=3"}), {"camera.widht", "width"}},
      {"ZeroAreaCamera", nothing, simulate({"--set", "camera.width=0"}), {"width"}},
      {"MissingMesh", nothing, simulate({"--set", "scene.meshes.0.file=none.obj"}), {"none.obj"}},
      {"EmptyMesh", file("scene.obj", "v 0 0 1\n"), simulate(), {"scene.obj"}},
      {"DegenerateMesh",
       file("scene.obj", "v 0 0 1\nv 0 0 1\nv 0 0 1\nf 1 2 3\n"),
       simulate(),
       {"scene.obj"}},
      {"NotANumberInMesh",
       file("scene.obj", "v nan -1 2\nv 1 -1 2\nv 0 1 2\nf 1 2 3\n"),
       simulate(),
       {"scene.obj"}},
      {"MissingTexture",
       [](const TemporaryFolder& folder) {
         folder.write("scene.obj",
                      "mtllib scene.mtl\nv -1 -1 2\nv 1 -1 2\nv 0 1 2\nvt 0 0\nvt 1 0\nvt 0 1\n"
                      "usemtl m\nf 1/1 2/2 3/3\n");
         folder.write("scene.mtl", "newmtl m\nmap_Kd none.png\n");
       },
       simulate(),
       {"none.png"}},
      {"MissingArchiveMember",
       nothing,
       simulate({"--set", "scene.meshes.0.file=@/furniture.sh3f!/desk.obj"}),
       {"furniture.sh3f"}},
      {"OneWaypoint",
       nothing,
       simulate({"--set", "trajectory.waypoints=[[0, 0, 0, 0, 0, 0, 0, 1]]"}),
       {"waypoints"}},
      {"NotANumberInPose",
       nothing,
       simulate({"--set",
                 "trajectory.waypoints=[[0, .nan, 0, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 0, 0, 1]]"}),
       {"waypoints"}},
      {"TrajectoryFileWithNan",
       file("poses.txt", "0 0 0 0 0 0 0 1\n0.1 nan 0 0 0 0 0 1\n"),
       simulate({"--set", "trajectory={source: file, file: @/poses.txt}"}),
       {"poses.txt:2"}},
      {"DurationBeyondTrajectory", nothing, simulate({"--set", "duration_s=9"}), {"duration_s"}},
      {"NoDataset", nothing, {"info", "@/nowhere"}, {"nowhere"}},
      {"NoEventsInThePart",
       nothing,
       {"statistics", "@/data", "-o", "@/out", "--start-s", "5"},
       {"events.txt", "no two events"}},
      {"NothingToCalibrateBy",
       nothing,
       {"calibrate", "@/data", "-o", "@/sensor.yaml", "--start-s", "5"},
       {"no two events"}},
      {"NoEvents",
       [](const TemporaryFolder& f) { fs::remove(f.path() / "data/events.txt"); },
       track(),
       {"events"}},
      {"WrongColumnCount",
       file("data/events.txt", "0.001 1 2 1\n0.002 3 4\n"),
       {"info", "@/data"},
       {"events.txt:2"}},
      {"EventsGoBackInTime",
       file("data/events.txt", "0.002 1 2 1\n0.001 3 4 0\n"),
       {"info", "@/data"},
       {"events.txt:2"}},
      {"EventOutsideSensor",
       file("data/events.txt", "0.001 1 2 1\n0.002 99 4 0\n"),
       {"info", "@/data"},
       {"events.txt:2", "99"}},
      {"PolarityNeitherOnNorOff",
       file("data/events.txt", "0.001 1 2 7\n"),
       {"info", "@/data"},
       {"events.txt:1"}},
      {"NanPose",
       file("data/groundtruth.txt", "0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n"),
       {"info", "@/data"},
       {"groundtruth.txt:2"}},
      {"QuaternionOfNoLength",
       file("data/groundtruth.txt", "0 0 0 0 0 0 0 0\n"),
       {"info", "@/data"},
       {"groundtruth.txt:1"}},
      {"PosesGoBackInTime",
       file("data/groundtruth.txt", "1 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n"),
       {"info", "@/data"},
       {"groundtruth.txt:2"}},
      {"BadCalibration",
       file("data/calib.txt", "200 200 15.5\n"),
       {"info", "@/data"},
       {"calib.txt:1"}},
      {"NegativeFocalLength",
       file("data/calib.txt", "-200 200 15.5 11.5 0 0 0 0 0\n"),
       {"info", "@/data"},
       {"calib.txt"}},
      {"TruncatedHdf5",
       file("data/events.h5", "\x89HDF\r\n\x1a\n and no more"),
       {"info", "@/data"},
       {"events.h5"}},
      {"MissingFrame",
       file("data/images.txt", "0.002 images/frame_00000000.png\n"),
       track(),
       {"frame_00000000.png"}},
      {"UnknownModule",
       nothing,
       {"run", "trak", "--data", "@/data", "-o", "@/out"},
       {"trak", "track"}},
      {"BrokenFrame",
       [](const TemporaryFolder& folder) {
         folder.write("data/images.txt", "0.002 images/frame.png\n");
         folder.write("data/images/frame.png", "no picture");
       },
       track(),
       {"frame.png"}},
      {"NoDepthToTrackOn",
       [](const TemporaryFolder& folder) {
         folder.write("data/images.txt", "0.002 images/frame.png\n");
         write_png(folder.path() / "data/images/frame.png", ImageU8(32, 24, 128));
       },
       {"run", "track", "--data", "@/data", "-o", "@/out"},
       {"data", "depth"}},
      {"FrameOfAnotherSize",
       [](const TemporaryFolder& folder) {
         folder.write("data/images.txt", "0.002 images/frame.png\n");
         write_png(folder.path() / "data/images/frame.png", ImageU8(30, 24, 128));
       },
       track(),
       {"frame", "30", "32"}},
      {"WindowWithoutEvents", nothing, track({"--start-s", "0.5"}), {"data", "no events"}},
      {"UnknownTrackingKey",
       nothing,
       track({"--set", "edges.sampels=3"}),
       {"edges.sampels", "did you mean 'samples'"}},
      {"NoSamples", nothing, track({"--set", "edges.samples=0"}), {"--set edges.samples", "0"}},
      {"NegativeSeed", nothing, simulate({"--seed", "-1"}), {"--seed", "-1", "whole number"}},
      {"NotANumberOption", nothing, track({"--duration-s", "nan"}), {"--duration-s", "nan"}},
      {"ConfigIncludesItself",
       config_line("include: simulation.yaml"),
       simulate(),
       {"simulation.yaml:8", "include"}},
      {"ConfigIsAFolder", nothing, {"simulate", "@/data", "-o", "@/out"}, {"data", "folder"}},
      {"EvalOfNoRun", nothing, {"eval", "@/data"}, {"run.yaml"}},
      {"BrokenTrajectory",
       file("est.txt", "0 0 0 0 0 0 0 1\n0.5 0 0 zero 0 0 0 1\n"),
       {"eval", "--trajectory", "@/est.txt", "--data", "@/data"},
       {"est.txt:2", "zero"}},
      {"ReportOfNoRun", nothing, {"report", "@/nowhere", "-o", "@/out"}, {"nowhere"}},
      {"NameTooLong",
       nothing,
       {"info", "@/" + std::string(300, 'a')},
       {"aaa: ", "File name too long"}},
      {"NameOfTheOutputTooLong",
       nothing,
       {"simulate", "@/simulation.yaml", "-o", "@/" + std::string(300, 'a')},
       {"aaa: ", "File name too long"}},
      {"NameOfAMeshTooLong",
       file("simulation.yaml",
            "scene:\n  meshes:\n    - {file: " + std::string(300, 'a') + ".obj}\n"),
       simulate(),
       {"simulation.yaml:3", "scene.meshes", "File name too long"}},
      {"LinksInACircle",
       [](const TemporaryFolder& folder) { fs::create_symlink("loop", folder.path() / "loop"); },
       {"run", "track", "--data", "@/loop", "-o", "@/out"},
       {"loop: ", "Too many levels of symbolic links"}},
      {"RenderToUnknownFormat", nothing, {"render", "@/data", "-o", "@/out.xyz"}, {"out.xyz"}},
      {"OverlayMissing",
       nothing,
       overlay({"--overlay", "@/none.png"}),
       {"none.png", "no such file"}},
      {"OverlayIsNoPicture",
       nothing,
       overlay({"--overlay", "@/data/calib.txt"}),
       {"calib.txt", "no picture"}},
      {"OverlayPoseTooShort",
       nothing,
       overlay({"--overlay", "@/none.png", "--overlay-pose", "1 2 3 0 0 1"}),
       {"--overlay-pose", "6 numbers instead of 7", "x y z qx qy qz qw"}},
      {"OverlayPoseNotANumber",
       nothing,
       overlay({"--overlay", "@/none.png", "--overlay-pose", "1 2 3 0 0 O 1"}),
       {"--overlay-pose", "character 11 (qz)", "'O'"}},
      {"OverlayOptionAlone",
       nothing,
       overlay({"--overlay-width", "2"}),
       {"--overlay-width requires --overlay"}},
  };
  return all;
}

class MalformedInput : public ::testing::TestWithParam<Case> {};

TEST_P(MalformedInput, IsAClearErrorWithItsPlace) {
  const Case& wrong = GetParam();
  const TemporaryFolder folder;
  write_recording(folder);
  write_simulation(folder);
  wrong.spoil(folder);
  std::vector<std::string> arguments;
  for (const std::string& argument : wrong.arguments)
    arguments.push_back(at(argument, folder.path()));

  const CommandResult result = run_command(SACCADE_COMMAND, arguments);

  EXPECT_EQ(result.exit_code, 2) << result.output;
  for (const std::string& text : wrong.says)
    EXPECT_NE(result.output.find(text), std::string::npos)
        << "should mention '" << text << "' but says:\n"
        << result.output;
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos)
        << "left behind: " << entry.path();
}

INSTANTIATE_TEST_SUITE_P(Cases, MalformedInput, ::testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

/// The files that the cases above spoil are valid as they are; otherwise a case proves nothing.
TEST(ValidInput, UnspoiltFilesAreAccepted) {
  const TemporaryFolder folder;
  write_recording(folder);
  write_simulation(folder);
  const std::string root = folder.path().string();
  const CommandResult info = run_command(SACCADE_COMMAND, {"info", root + "/data"});
  EXPECT_EQ(info.exit_code, 0) << info.output;
  const CommandResult simulated =
      run_command(SACCADE_COMMAND, {"simulate", root + "/simulation.yaml", "-o", root + "/out"});
  EXPECT_EQ(simulated.exit_code, 0) << simulated.output;
  EXPECT_TRUE(fs::exists(folder.path() / "out" / "dataset.yaml"));
}

}  // namespace
}  // namespace saccade::testing
