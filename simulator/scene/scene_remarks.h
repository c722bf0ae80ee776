#pragma once

#include <string>
#include <vector>

namespace saccade {

/// What a scene shows otherwise than its files say, collected while they are read: few lines,
/// however many materials there are.
class SceneRemarks {
 public:
  /// A line of its own; the same one counts once.
  void say(const std::string& line);
  /// Something that `file` states and that is not shown: all such things share one line.
  void ignore(const std::string& feature, const std::string& file);
  /// A material of `file` that is translucent: these share one line as well.
  void cut_out(const std::string& material, const std::string& file);

  /// A picture that `file` asks for, that is missing and for which grey is shown: likewise.
  void show_grey(const std::string& picture, const std::string& file);

  /// In the order in which they came, the shared lines last.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  using Names = std::vector<std::string>;

  Names said_;
  Names ignored_, ignoring_files_;
  Names cut_out_, cut_out_files_;
  Names missing_, missing_files_;
};

}  // namespace saccade
