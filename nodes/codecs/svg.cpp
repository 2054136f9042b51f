#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "nodes/codecs/codecs.h"

namespace {

struct Free {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};

/// Throws with what the library says.
[[noreturn]] void complain(GError* error) {
  const std::string cause = error ? error->message : "unknown cause";
  g_clear_error(&error);
  throw std::runtime_error(cause);
}

/// 32 bits a pixel, as Cairo draws, to BGR.
cv::Mat to_bgr(cairo_surface_t* picture) {
  const cv::Mat drawn(cairo_image_surface_get_height(picture), cairo_image_surface_get_width(picture), CV_8UC4,
                      cairo_image_surface_get_data(picture),
                      static_cast<std::size_t>(cairo_image_surface_get_stride(picture)));
  cv::Mat pixels(drawn.size(), CV_8UC3);
  cv::mixChannels({drawn}, {pixels}, {0, 0, 1, 1, 2, 2});
  return pixels;
}

}  // namespace

void codec_draw_svg(const std::string& svg, double scale, cv::Mat& pixels) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, Free> plot(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!plot) complain(error);
  double width = 0, height = 0;
  if (!rsvg_handle_get_intrinsic_size_in_pixels(plot.get(), &width, &height) || width <= 0 || height <= 0)
    throw std::runtime_error("it has no width and height in pixels");
  const RsvgRectangle all{0, 0, std::ceil(width * scale), std::ceil(height * scale)};
  constexpr double most = 32767;  // of Cairo
  if (all.width > most || all.height > most)
    throw std::runtime_error(
        fmt::format("{} x {} pixels are more than a picture can have; lower \"scale\"", all.width, all.height));
  const std::unique_ptr<cairo_surface_t, Free> picture(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(all.width), static_cast<int>(all.height)));
  const std::unique_ptr<cairo_t, Free> cairo(cairo_create(picture.get()));
  cairo_set_source_rgb(cairo.get(), 1, 1, 1);
  cairo_paint(cairo.get());
  if (!rsvg_handle_render_document(plot.get(), cairo.get(), &all, &error)) complain(error);
  if (const auto status = cairo_status(cairo.get()); status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(cairo_status_to_string(status));
  cairo_surface_flush(picture.get());
  pixels = to_bgr(picture.get());
}
