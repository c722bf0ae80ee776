#include "simulator/scene/mesh/quake3/quake3_shader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace saccade {
namespace {

using Words = std::vector<std::string>;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// A script line by line: words in lower case, without comments, each brace a line of its own.
std::vector<Words> lines_of(std::string_view text) {
  std::vector<Words> lines(1);
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) lines.back().push_back(lower(word));
    word.clear();
  };
  const auto end_line = [&] {
    end_word();
    if (!lines.back().empty()) lines.emplace_back();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("//")) {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (rest.starts_with("/*")) {
      i = std::min(text.find("*/", i + 2), text.size() - 1) + 1;
    } else if (text[i] == '{' || text[i] == '}') {
      end_line();
      lines.back().emplace_back(1, text[i]);
      end_line();
    } else if (text[i] == '\n' || text[i] == '\r') {
      end_line();
    } else if (std::isspace(static_cast<unsigned char>(text[i])) != 0 || text[i] == '"') {
      end_word();
    } else {
      word += text[i];
    }
  }
  end_line();
  lines.pop_back();
  return lines;
}

/// A picture that is drawn, over what earlier stages drew.
struct Stage {
  std::string picture;  ///< "": none of a file
  bool is_there = false;
  bool is_clamped = false;
  bool is_reflection = false;
  bool is_tested = false;  ///< by its alpha
  bool moves = false;
  Words blend;
  Eigen::Vector2d uv_scale{1, 1};

  /// Whether nothing of what is behind it is seen through it.
  [[nodiscard]] bool replaces() const {
    return blend.empty() || (blend.size() > 1 && blend[0] == "gl_one" && blend[1] == "gl_zero");
  }
  [[nodiscard]] bool fades() const {
    return !blend.empty() &&
           (blend[0] == "blend" || (blend.size() > 1 && blend[0] == "gl_src_alpha" &&
                                    blend[1] == "gl_one_minus_src_alpha"));
  }
};

void set_picture(const std::string& name, Stage& stage) {
  stage.is_there = true;
  if (!name.starts_with('$') && !name.starts_with('*')) stage.picture = name;
}

double number(const std::string& word) {
  const double value = std::strtod(word.c_str(), nullptr);
  return std::isfinite(value) ? value : 0;
}

void read_stage_line(const Words& words, Stage& stage) {
  const std::string& key = words.front();
  if ((key == "map" || key == "clampmap") && words.size() > 1) {
    set_picture(words[1], stage);
    stage.is_clamped = key == "clampmap";
  } else if (key == "animmap" && words.size() > 2) {
    set_picture(words[2], stage);
    stage.moves = true;
  } else if (key == "blendfunc") {
    stage.blend.assign(words.begin() + 1, words.end());
  } else if (key == "alphafunc" && words.size() > 1) {
    stage.is_tested = words[1] != "lt128";  // shown as a whole
  } else if (key == "tcgen" && words.size() > 1) {
    stage.is_reflection = words[1] == "environment";
  } else if (key == "tcmod" && words.size() > 3 && words[1] == "scale") {
    stage.uv_scale = {number(words[2]), number(words[3])};
  } else if (key == "tcmod") {
    stage.moves = true;
  }
}

/// A shader while it is read.
struct Definition {
  std::vector<Stage> stages;
  std::string editor_picture;
  bool is_left_out = false;
  bool is_sprite = false;
};

void read_shader_line(const Words& words, Definition& shader) {
  const std::string& key = words.front();
  if (key == "surfaceparm" && words.size() > 1)
    shader.is_left_out =
        shader.is_left_out || words[1] == "nodraw" || words[1] == "sky" || words[1] == "fog";
  if (key == "skyparms") shader.is_left_out = true;
  if (key == "deformvertexes" && words.size() > 1)
    shader.is_sprite = shader.is_sprite || words[1].starts_with("autosprite");
  if (key == "qer_editorimage" && words.size() > 1) shader.editor_picture = words[1];
}

Quake3Shader shader_of(const Definition& definition) {
  Quake3Shader shader;
  if (definition.is_left_out) shader.coverage = Quake3Coverage::kNone;
  if (definition.is_sprite) {
    shader.coverage = Quake3Coverage::kNone;
    shader.ignored.emplace_back("sprites that turn to the camera");
  }
  // A reflection is shown only where there is nothing else.
  auto base = std::ranges::find_if(definition.stages, [](const Stage& stage) {
    return !stage.picture.empty() && !stage.is_reflection;
  });
  if (base == definition.stages.end())
    base = std::ranges::find_if(definition.stages,
                                [](const Stage& stage) { return !stage.picture.empty(); });
  if (base == definition.stages.end()) {
    shader.picture = definition.editor_picture;
    return shader;
  }
  shader.picture = base->picture;
  shader.is_clamped = base->is_clamped;
  shader.uv_scale = base->uv_scale;
  if (base->moves) shader.ignored.emplace_back("motion of textures");
  const bool is_on_ground = std::any_of(definition.stages.begin(), base, [](const Stage& stage) {
    return stage.is_there && stage.replaces() && !stage.is_tested;
  });
  if (shader.coverage == Quake3Coverage::kNone || is_on_ground) return shader;
  if (base->is_tested || base->fades()) {
    shader.coverage = Quake3Coverage::kWhereOpaque;
  } else if (!base->replaces()) {
    shader.coverage = Quake3Coverage::kNone;
    shader.ignored.emplace_back("surfaces that add or filter light");
  }
  return shader;
}

}  // namespace

std::map<std::string, Quake3Shader> parse_quake3_script(std::string_view text) {
  std::map<std::string, Quake3Shader> shaders;
  std::string name;
  Definition definition;
  int depth = 0;
  for (const Words& words : lines_of(text)) {
    if (words.front() == "{") {
      ++depth;
      if (depth == 1) definition = {};
      if (depth == 2) definition.stages.emplace_back();
    } else if (words.front() == "}") {
      if (depth == 1 && !name.empty()) shaders.try_emplace(name, shader_of(definition));
      if (depth == 1) name.clear();
      depth = std::max(depth - 1, 0);
    } else if (depth == 0) {
      name = words.front();
    } else if (depth == 1) {
      read_shader_line(words, definition);
    } else if (depth == 2) {
      read_stage_line(words, definition.stages.back());
    }
  }
  return shaders;
}

}  // namespace saccade
