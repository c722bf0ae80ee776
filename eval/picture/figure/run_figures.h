#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/run_folder.h"

namespace saccade {

/// What a figure is drawn from, and how.
struct FigureInput {
  const RunFolder& run;
  const Dataset& dataset;
  int upscale = 2;  ///< screen pixels per sensor pixel
  Theme theme = kLightTheme;
};

using FigureRows = std::vector<std::vector<CaptionedPicture>>;

/// A figure of a run that its contact sheet does not show.
struct RunFigure {
  std::string_view name;   ///< value of --figure
  std::string_view help;   ///< what it shows
  std::string_view needs;  ///< what a run must have written, for the error where it has not
  /// Rows of pictures; none where the run has nothing to draw it from.
  FigureRows (*draw)(const FigureInput&) = nullptr;
};

[[nodiscard]] std::span<const RunFigure> run_figures();

/// The figure named `name` below `title`. InputError for an unknown name, with the nearest one, and
/// where the run lacks what it needs.
[[nodiscard]] ImageRgb8 draw_run_figure(std::string_view name, const std::string& title,
                                        const FigureInput& input);

}  // namespace saccade
