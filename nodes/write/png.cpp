#include "nodes/write/png.h"

#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "graph/output_file.h"

namespace talkgraph {
namespace {

struct Free {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};

/// Throws with what the library says.
[[noreturn]] void complain(const std::filesystem::path& file, GError* error) {
  const std::string cause = error ? error->message : "unknown cause";
  g_clear_error(&error);
  throw std::runtime_error(fmt::format("{}: the plot cannot be drawn: {}", file.string(), cause));
}

void check(cairo_status_t status, const std::filesystem::path& file, const char* what) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(fmt::format("{}: {}: {}", file.string(), what, cairo_status_to_string(status)));
}

}  // namespace

void write_png(const std::filesystem::path& file, const std::string& svg, double scale) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, Free> plot(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!plot) complain(file, error);
  double width = 0, height = 0;
  if (!rsvg_handle_get_intrinsic_size_in_pixels(plot.get(), &width, &height) || width <= 0 || height <= 0)
    throw std::runtime_error(file.string() + ": the plot cannot be drawn: it has no width and height in pixels");
  const RsvgRectangle all{0, 0, std::ceil(width * scale), std::ceil(height * scale)};
  constexpr double most = 32767;  // of Cairo
  if (all.width > most || all.height > most)
    throw std::runtime_error(fmt::format("{}: {} x {} pixels are more than a picture can have; lower \"scale\"",
                                         file.string(), all.width, all.height));
  const std::unique_ptr<cairo_surface_t, Free> picture(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(all.width), static_cast<int>(all.height)));
  const std::unique_ptr<cairo_t, Free> cairo(cairo_create(picture.get()));
  cairo_set_source_rgb(cairo.get(), 1, 1, 1);
  cairo_paint(cairo.get());
  if (!rsvg_handle_render_document(plot.get(), cairo.get(), &all, &error)) complain(file, error);
  check(cairo_status(cairo.get()), file, "the plot cannot be drawn");
  OutputFile whole(file);
  check(cairo_surface_write_to_png(picture.get(), whole.part().c_str()), file, "cannot be written");
  whole.finish();
}

}  // namespace talkgraph
