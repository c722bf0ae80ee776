#include "eval/information/information_text.h"

#include <fmt/format.h>

#include "core/error.h"
#include "eval/information/information.h"

namespace saccade {
namespace {

std::string line(const char* what, const std::string& bound, bool is_enough) {
  return fmt::format("  {:<32}{:<32}  {}\n", what, bound, is_enough ? "enough" : "too little");
}

}  // namespace

std::string describe_information(const std::filesystem::path& dataset) {
  const auto found = information_of(Dataset::open(dataset));
  if (!found)
    throw InputError(dataset.string(),
                     "its information needs true poses, frames, and depth at the frames' times");
  std::string text = fmt::format("what dataset {} tells at best\n", dataset.string());
  text += line("pose before a known map",
               fmt::format("{:.2g} % of depth, {:.2g} deg", found->pose_percent, found->pose_deg),
               found->is_enough_for("track"));
  text += line("path from given first poses", fmt::format("{:.2g} % of depth", found->path_percent),
               found->is_enough_for("odometry"));
  text += line("path from events alone", fmt::format("{:.2g} % of depth", found->own_path_percent),
               found->is_enough_for("odometry", false));
  text += line("depth to 5 %", fmt::format("{:.2g} % of edge pixels", 100 * found->depth_share),
               found->is_enough_for("depth"));
  return text;
}

}  // namespace saccade
