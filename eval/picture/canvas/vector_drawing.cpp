#include "eval/picture/canvas/vector_drawing.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

constexpr double kPointsPerPixel = 0.75;
/// Files name no moment at which they were made, so that equal figures are equal files.
constexpr const char* kDate = "2000-01-01T00:00:00Z";
/// A font is measured at a size at which its hinting does not matter.
constexpr double kMeasuredSize = 1000;

cairo_status_t append(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// cairo numbers the surfaces of a process, whatever they are of: here they count from 1.
std::string with_own_numbers(const std::string& svg) {
  constexpr std::string_view kSurface = "surface";
  std::map<std::string, std::size_t> numbers;
  std::string result;
  std::size_t at = 0;
  for (std::size_t found; (found = svg.find(kSurface, at)) != std::string::npos;) {
    const std::size_t begin = found + kSurface.size();
    const std::size_t end = std::min(svg.find_first_not_of("0123456789", begin), svg.size());
    const std::string number = svg.substr(begin, end - begin);
    result.append(svg, at, begin - at);
    if (!number.empty())
      result += std::to_string(numbers.emplace(number, numbers.size() + 1).first->second);
    at = end;
  }
  return result.append(svg, at);
}

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw InputError("figure", std::string("cannot be drawn: ") + cairo_status_to_string(status));
}

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;

void set_up(cairo_t* context) {
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_font_options_t* options = cairo_font_options_create();
  // Widths that do not depend on the size: the same letters for every magnification.
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_set_font_options(context, options);
  cairo_font_options_destroy(options);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
}

void set_colour(cairo_t* context, const Rgb8& colour) {
  cairo_set_source_rgb(context, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
}

}  // namespace

void VectorDrawing::DestroyContext::operator()(_cairo* context) const { cairo_destroy(context); }

VectorDrawing::VectorDrawing() {
  const Surface nowhere(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  letters_.reset(cairo_create(nowhere.get()));
  set_up(letters_.get());
  cairo_set_font_size(letters_.get(), kMeasuredSize);
  cairo_text_extents_t extents;
  cairo_text_extents(letters_.get(), "H", &extents);
  check(cairo_status(letters_.get()));
  if (extents.height > 0) capital_height_ = extents.height / kMeasuredSize;
}

void VectorDrawing::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb8& colour,
                         int thickness) {
  const Eigen::Vector2d points[] = {from, to};
  polyline(points, colour, thickness);
}

void VectorDrawing::polyline(std::span<const Eigen::Vector2d> points, const Rgb8& colour,
                             int thickness) {
  std::vector<Eigen::Vector2d> finite;
  for (const Eigen::Vector2d& point : points)
    if (point.allFinite()) finite.push_back(point);
  strokes_.emplace_back([finite, colour, thickness](cairo_t* context) {
    for (const Eigen::Vector2d& point : finite) cairo_line_to(context, point.x(), point.y());
    set_colour(context, colour);
    cairo_set_line_width(context, thickness);
    cairo_stroke(context);
  });
}

void VectorDrawing::disc(const Eigen::Vector2d& centre, double radius, const Rgb8& colour) {
  if (!centre.allFinite()) return;
  strokes_.emplace_back([centre, radius, colour](cairo_t* context) {
    set_colour(context, colour);
    cairo_arc(context, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
    cairo_fill(context);
  });
}

void VectorDrawing::rectangle(const Eigen::Vector2d& top_left, const Eigen::Vector2d& size,
                              const Rgb8& colour) {
  strokes_.emplace_back([top_left, size, colour](cairo_t* context) {
    set_colour(context, colour);
    cairo_rectangle(context, top_left.x(), top_left.y(), size.x(), size.y());
    cairo_fill(context);
  });
}

void VectorDrawing::text(const std::string& text, const Eigen::Vector2d& baseline_left,
                         const Rgb8& colour, double height) {
  strokes_.emplace_back(
      [text, baseline_left, colour, size = height / capital_height_](cairo_t* context) {
        set_colour(context, colour);
        cairo_set_font_size(context, size);
        cairo_move_to(context, baseline_left.x(), baseline_left.y());
        cairo_show_text(context, text.c_str());
        cairo_new_path(context);
      });
}

double VectorDrawing::extent_of(const std::string& text, double height) const {
  cairo_set_font_size(letters_.get(), height / capital_height_);
  cairo_text_extents_t extents;
  cairo_text_extents(letters_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void VectorDrawing::save(const std::filesystem::path& file, int width, int height) const {
  const bool is_pdf = file.extension() == ".pdf";
  SACCADE_CHECK(is_pdf || file.extension() == ".svg");
  const double width_pt = width * kPointsPerPixel, height_pt = height * kPointsPerPixel;
  std::string bytes;
  const Surface page(
      is_pdf ? cairo_pdf_surface_create_for_stream(append, &bytes, width_pt, height_pt)
             : cairo_svg_surface_create_for_stream(append, &bytes, width_pt, height_pt));
  if (is_pdf) cairo_pdf_surface_set_metadata(page.get(), CAIRO_PDF_METADATA_CREATE_DATE, kDate);
  {
    // Drawn anew for each file: cairo 1.16 plays its own recordings with an offset that varies.
    const std::unique_ptr<_cairo, DestroyContext> onto(cairo_create(page.get()));
    set_up(onto.get());
    cairo_scale(onto.get(), kPointsPerPixel, kPointsPerPixel);
    for (const auto& stroke : strokes_) stroke(onto.get());
    check(cairo_status(onto.get()));
  }
  cairo_surface_finish(page.get());
  check(cairo_surface_status(page.get()));
  write_atomically(file, is_pdf ? bytes : with_own_numbers(bytes));
}

}  // namespace saccade
