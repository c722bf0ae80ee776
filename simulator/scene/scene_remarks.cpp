#include "simulator/scene/scene_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace saccade {
namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// "chair.glb" or "chair.glb and 3 more".
std::string first_of(const std::vector<std::string>& names) {
  return names.size() == 1 ? names.front()
                           : fmt::format("{} and {} more", names.front(), names.size() - 1);
}

}  // namespace

void SceneRemarks::say(const std::string& line) { add_once(said_, line); }

void SceneRemarks::ignore(const std::string& feature, const std::string& file) {
  add_once(ignored_, feature);
  add_once(ignoring_files_, file);
}

void SceneRemarks::cut_out(const std::string& material, const std::string& file) {
  add_once(cut_out_, material);
  add_once(cut_out_files_, file);
}

void SceneRemarks::show_grey(const std::string& picture, const std::string& file) {
  add_once(missing_, picture);
  add_once(missing_files_, file);
}

std::vector<std::string> SceneRemarks::lines() const {
  std::vector<std::string> lines = said_;
  if (!missing_.empty())
    lines.push_back(fmt::format("{}: missing pictures are grey 0.5: {}", first_of(missing_files_),
                                first_of(missing_)));
  if (!cut_out_.empty())
    lines.push_back(
        fmt::format("{}: translucent materials are cut out where their opacity is below 0.5: {}",
                    first_of(cut_out_files_), first_of(cut_out_)));
  if (!ignored_.empty())
    lines.push_back(fmt::format("{}: surfaces show their base colour; not shown: {}",
                                first_of(ignoring_files_), fmt::join(ignored_, ", ")));
  return lines;
}

}  // namespace saccade
