#include "nodes/speaker/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "graph/random.h"
#include "nodes/speaker/face.h"

namespace talkgraph::face {
namespace {

using Colour = cv::Vec3f;  // blue, green, red, 0 to 1
using Picture = cv::Mat_<Colour>;
using Plane = cv::Mat_<float>;
using Outline = std::vector<Point>;

constexpr int width = static_cast<int>(canvas_width) * paint_scale;
constexpr int height = static_cast<int>(canvas_height) * paint_scale;

Colour rgb(double r, double g, double b) {
  return {static_cast<float>(b / 255), static_cast<float>(g / 255), static_cast<float>(r / 255)};
}

/// Coverage 0 to 1 of a closed outline given in units, edges blurred.
Plane fill(const Outline& outline, double blur) {
  std::vector<cv::Point> points;
  constexpr int shift = 4;
  for (const auto& p : outline)
    points.emplace_back(static_cast<int>(std::lround(p.x() * paint_scale * (1 << shift))),
                        static_cast<int>(std::lround(p.y() * paint_scale * (1 << shift))));
  cv::Mat1b mask(height, width, uchar{0});
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{points}, 255, cv::LINE_AA, shift);
  Plane plane;
  mask.convertTo(plane, CV_32F, 1 / 255.0);
  if (blur > 0) cv::GaussianBlur(plane, plane, {}, blur * paint_scale);
  return plane;
}

/// A smooth closed curve through mirrored points of the right half, from top to bottom.
Outline mirrored(const Outline& right) {
  Outline all = right;
  for (auto it = right.rbegin(); it != right.rend(); ++it) all.emplace_back(2 * centre_x - it->x(), it->y());
  return all;
}

/// Corners rounded off (Chaikin).
Outline rounded(Outline outline) {
  for (int pass = 0; pass < 3; ++pass) {
    Outline next;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
      next.push_back(0.75 * a + 0.25 * b);
      next.push_back(0.25 * a + 0.75 * b);
    }
    outline = std::move(next);
  }
  return outline;
}

Outline ellipse(Point centre, double rx, double ry) {
  Outline all;
  for (int i = 0; i < 72; ++i) {
    const double angle = i * 0.0872664625997165;
    all.emplace_back(centre.x() + rx * std::cos(angle), centre.y() + ry * std::sin(angle));
  }
  return all;
}

/// For every pixel, f(x, y) in units.
template <class F>
Plane plane_of(F f) {
  Plane plane(height, width);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c)
      plane(r, c) = static_cast<float>(f((c + 0.5) / paint_scale, (r + 0.5) / paint_scale));
  return plane;
}

double bell(double x, double y, double cx, double cy, double sx, double sy) {
  const double a = (x - cx) / sx, b = (y - cy) / sy;
  return std::exp(-0.5 * (a * a + b * b));
}

/// A pair of bells, left and right of the middle line.
double bells(double x, double y, double off, double cy, double sx, double sy) {
  return bell(std::abs(x - centre_x), y, off, cy, sx, sy);
}

/// Smooth noise with standard deviation about 1; grains of `size` units.
Plane noise(double size, Random& random) {
  const int columns = std::max(2, static_cast<int>(canvas_width / size)),
            rows = std::max(2, static_cast<int>(canvas_height / size));
  Plane coarse(rows, columns), fine;
  for (float& value : coarse) value = static_cast<float>(random.normal());
  cv::resize(coarse, fine, {width, height}, 0, 0, cv::INTER_CUBIC);
  return fine;
}

void mix(Picture& picture, const Plane& mask, Colour colour, double amount = 1) {
  const float* m = mask[0];
  const auto a = static_cast<float>(amount);
  for (auto& p : picture) {
    const float t = std::clamp(a * *m++, 0.0F, 1.0F);
    p += (colour - p) * t;
  }
}

void mix(Picture& picture, const Plane& mask, const Picture& other) {
  const float* m = mask[0];
  const Colour* o = other[0];
  for (auto& p : picture) {
    p += (*o++ - p) * *m++;
  }
}

/// Multiplies by 1 + amount · mask.
void shade(Picture& picture, const Plane& mask, double amount) {
  const float* m = mask[0];
  for (auto& p : picture) p *= std::max(0.0F, 1 + static_cast<float>(amount) * *m++);
}

double ramp(double from, double to, double x) {
  x = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// Height of the skin towards the viewer, units: what the light falls on.
double relief(double x, double y) {
  const double dx = x - centre_x;
  const double skull = std::max(0.02, 1 - std::pow(std::abs(dx) / 78, 2.4) - std::pow(std::abs(y - 142) / 132, 2.6));
  double z = 62 * std::pow(skull, 0.5);
  const double along_nose = std::clamp((y - 112) / 58, 0.0, 1.0);
  z += (1.5 + 10.5 * along_nose) * std::exp(-0.5 * std::pow(dx / (6.5 + 3 * along_nose), 2)) * ramp(100, 138, y) *
       (1 - ramp(166, 184, y));
  z += 6.5 * bell(x, y, centre_x, 168, 8, 7) + 4.2 * bells(x, y, 11, 172, 4.6, 5);
  z += -5.5 * bells(x, y, 28, 127, 15, 10) + 5 * bells(x, y, 32, 134, 13, 8);
  z += 2.6 * bells(x, y, 31, 110, 22, 8) + 5 * bells(x, y, 42, 163, 17, 15);
  z += -2.4 * bells(x, y, 30, 192, 5, 14) + 5.5 * bell(x, y, centre_x, 235, 14, 9) -
       4 * bell(x, y, centre_x, 220.5, 17, 4.5);
  const double line = lip_line(x), lips = 1 - ramp(20, 30, std::abs(dx));
  z += lips * (3.2 * bell(x, y, centre_x, line - 4, 19, 3.4) + 4.6 * bell(x, y, centre_x, line + 5, 17, 4) -
               3 * bell(x, y, centre_x, line, 24, 1.1));
  z +=
      -1.2 * bell(x, y, centre_x, 189, 2.6, 6) + 1.0 * bells(x, y, 4.5, 190, 2, 6) - 2.5 * bells(x, y, 30, 205, 4.5, 6);
  return z;
}

/// Light from the upper left on a relief: diffuse and glossy parts.
struct Light {
  Plane diffuse, gloss;
};
Light light_on(const Plane& relief) {
  Light light{Plane(height, width), Plane(height, width)};
  const cv::Vec3d source = cv::normalize(cv::Vec3d(-0.42, -0.5, 0.85)),
                  half = cv::normalize(source + cv::Vec3d(0, 0, 1));
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const int left = std::max(0, c - 1), right = std::min(width - 1, c + 1), up = std::max(0, r - 1),
                down = std::min(height - 1, r + 1);
      const double gx = (relief(r, right) - relief(r, left)) * paint_scale / (right - left);
      const double gy = (relief(down, c) - relief(up, c)) * paint_scale / (down - up);
      const cv::Vec3d normal = cv::normalize(cv::Vec3d(-gx, -gy, 1));
      light.diffuse(r, c) = static_cast<float>(std::max(0.0, (normal.dot(source) + 0.25) / 1.25));
      light.gloss(r, c) = static_cast<float>(std::pow(std::max(0.0, normal.dot(half)), 22));
    }
  return light;
}

/// Shadows turn skin redder before they turn it dark.
void illuminate(Picture& picture, const Light& light, double gloss) {
  const float* d = light.diffuse[0];
  const float* g = light.gloss[0];
  for (auto& p : picture) {
    const float s = *d++;
    p[0] *= 0.20F + 0.92F * s;
    p[1] *= 0.26F + 0.87F * s;
    p[2] *= 0.38F + 0.76F * s;
    const float shine = static_cast<float>(gloss) * *g++;
    for (int k = 0; k < 3; ++k) p[k] += shine * (1 - p[k]);
  }
}

Outline face_outline() {
  Outline right{{centre_x, 40}, {centre_x + 28, 42}, {centre_x + 50, 54}, {centre_x + 62, 74}, {centre_x + 67.5, 100}};
  for (double y = 128; y < chin_bottom - 0.5; y += 1.5) right.emplace_back(centre_x + half_width(y), y);
  right.emplace_back(centre_x, chin_bottom);
  return mirrored(right);
}

Outline lip_outline(bool upper) {
  Outline all;
  for (double u = -1; u <= 1.001; u += 0.04) {
    const double x = centre_x + u * mouth_half_width;
    const double envelope = std::pow(std::max(0.0, 1 - u * u), 0.8);
    const double bow = 1.6 * std::exp(-u * u / 0.012), peaks = 1.2 * std::exp(-std::pow((std::abs(u) - 0.2) / 0.16, 2));
    all.emplace_back(x, lip_line(x) + (upper ? -(7.8 * envelope + peaks - bow) : 10.2 * std::pow(envelope, 0.85)));
  }
  for (double u = 1; u >= -1.001; u -= 0.04) {
    const double x = centre_x + u * mouth_half_width;
    all.emplace_back(x, lip_line(x));
  }
  return all;
}

/// A tapering stroke, as of a hair.
void stroke(cv::Mat3b& picture, Point from, Point bend, Point to, Colour colour, double thickness) {
  std::vector<cv::Point> points;
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    const Point p = (1 - t) * (1 - t) * from + 2 * t * (1 - t) * bend + t * t * to;
    points.emplace_back(static_cast<int>(std::lround(p.x() * paint_scale * 16)),
                        static_cast<int>(std::lround(p.y() * paint_scale * 16)));
  }
  const Colour c = colour * 255;
  cv::polylines(picture, points, false, cv::Scalar(c[0], c[1], c[2]),
                std::max(1, static_cast<int>(std::lround(thickness * paint_scale))), cv::LINE_AA, 4);
}

/// Draws strokes on a copy and keeps `amount` of them.
template <class F>
void strokes(Picture& picture, double amount, F draw) {
  cv::Mat3b bytes;
  picture.convertTo(bytes, CV_8U, 255);
  draw(bytes);
  Picture drawn;
  bytes.convertTo(drawn, CV_32F, 1 / 255.0);
  picture = picture * (1 - amount) + drawn * amount;
}

void paint_background(Picture& picture, Random& random) {
  const auto fog = noise(90, random), blotch = noise(40, random);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const double x = (c + 0.5) / paint_scale, y = (r + 0.5) / paint_scale;
      const double light = 0.62 + 0.5 * bell(x, y, 110, 90, 150, 130) + 0.035 * fog(r, c) + 0.015 * blotch(r, c);
      picture(r, c) = rgb(118, 134, 148) * static_cast<float>(light);
    }
}

void paint_shoulders(Picture& picture, Random& random) {
  const Outline outline = mirrored({{centre_x, 275},
                                    {centre_x + 32, 271},
                                    {centre_x + 46, 266},
                                    {centre_x + 80, 271},
                                    {centre_x + 118, 278},
                                    {centre_x + 146, 287},
                                    {centre_x + 158, 300},
                                    {centre_x, 300}});
  const auto knit = noise(1.2, random), folds = noise(22, random);
  Picture cloth(height, width);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const double x = (c + 0.5) / paint_scale, y = (r + 0.5) / paint_scale;
      const double light = 0.95 + 0.35 * bell(x, y, 100, 272, 60, 20) - 0.35 * ramp(230, 330, x) + 0.06 * knit(r, c) +
                           0.06 * folds(r, c) + 0.04 * std::sin(x * 2.1);
      cloth(r, c) = rgb(44, 62, 92) * static_cast<float>(light);
    }
  mix(picture, fill(outline, 0.7), cloth);
  const auto collar = plane_of([](double x, double y) {
    const double edge = 269 + 10 * std::pow((x - centre_x) / 44, 2) * -1 + 12;
    return std::abs(x - centre_x) < 44 ? std::exp(-0.5 * std::pow((y - edge) / 1.4, 2)) : 0.0;
  });
  shade(picture, collar, -0.35);
}

void paint_neck(Picture& picture, const Plane& grain) {
  const Outline outline = mirrored({{centre_x, 200},
                                    {centre_x + 46, 200},
                                    {centre_x + 44, 240},
                                    {centre_x + 46, 266},
                                    {centre_x + 44, 276},
                                    {centre_x + 26, 284},
                                    {centre_x, 288}});
  Picture skin(height, width);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const double x = (c + 0.5) / paint_scale, y = (r + 0.5) / paint_scale, dx = (x - centre_x) / 46;
      const double round = std::sqrt(std::max(0.05, 1 - dx * dx)) - 0.28 * dx;
      const double under_chin = 1 - 0.62 * (1 - ramp(244, 275, y + 14 * dx * dx - 4 * dx));
      const double throat = 0.05 * bell(x, y, centre_x - 14, 262, 3, 14) -
                            0.06 * bell(x, y, centre_x - 9, 262, 2.5, 14) + 0.05 * bell(x, y, centre_x, 262, 6, 5);
      const double light = (0.32 + 0.66 * round + throat) * under_chin + 0.012 * grain(r, c);
      skin(r, c) = rgb(214, 160, 130)
                       .mul({static_cast<float>(0.86 * light), static_cast<float>(0.92 * light),
                             static_cast<float>(1.02 * light)});
    }
  mix(picture, fill(outline, 0.7), skin);
}

void paint_ears(Picture& picture) {
  for (const double side : {-1.0, 1.0}) {
    const double x = centre_x + side * 69.5, light = side < 0 ? 1.0 : 0.72;
    mix(picture, fill(ellipse({x, 147}, 9.5, 21), 0.7), rgb(205 * light, 142 * light, 118 * light));
    mix(picture, fill(ellipse({x - side * 0.5, 146}, 5.2, 14), 1.6), rgb(150 * light, 88 * light, 72 * light), 0.75);
    mix(picture, fill(ellipse({x + side * 4.0, 143}, 2.4, 15), 1.4), rgb(228 * light, 170 * light, 146 * light), 0.6);
    mix(picture, fill(ellipse({x + side * 0.5, 161}, 4.2, 5.5), 1.6), rgb(214 * light, 146 * light, 122 * light), 0.7);
  }
}

Picture paint_skin(const Plane& grain, Random& random) {
  Picture skin(height, width, rgb(232, 184, 156));
  const auto blotch = noise(9, random), patches = noise(24, random);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      auto& p = skin(r, c);
      const float tone = 0.010F * blotch(r, c) + 0.010F * patches(r, c), pore = 0.011F * grain(r, c);
      p[0] *= 1 - 1.3F * tone + pore;
      p[1] *= 1 - 0.9F * tone + pore;
      p[2] *= 1 + 0.3F * tone + pore;
    }
  mix(skin, plane_of([](double x, double y) {
        return bells(x, y, 42, 168, 15, 12) + 0.8 * bell(x, y, centre_x, 168, 9, 8) +
               0.35 * bells(x, y, 66, 140, 8, 25) + 0.25 * bell(x, y, centre_x, 236, 12, 7);
      }),
      rgb(214, 118, 104), 0.30);
  mix(skin, plane_of([](double x, double y) {
        const double beard =
            ramp(186, 212, y + 0.12 * std::abs(x - centre_x)) * (1 - 0.55 * bells(x, y, 24, 196, 12, 12));
        return beard + 0.8 * bell(x, y, centre_x, 190, 17, 5);
      }),
      rgb(150, 124, 112), 0.17);
  mix(skin,
      plane_of([](double x, double y) { return bells(x, y, 31, 131, 15, 8) + 0.7 * bells(x, y, 30, 147, 13, 4); }),
      rgb(168, 106, 96), 0.28);
  return skin;
}

void paint_freckles(Picture& skin, Random& random) {
  strokes(skin, 0.30, [&](cv::Mat3b& bytes) {
    for (int i = 0; i < 130; ++i) {
      const double x = centre_x + 34 * random.normal() * 0.9, y = 160 + 13 * random.normal();
      const double radius = random.uniform(0.3, 0.8);
      const Colour c = rgb(160, 100, 72) * 255;
      cv::circle(bytes, {static_cast<int>(x * paint_scale * 16), static_cast<int>(y * paint_scale * 16)},
                 static_cast<int>(radius * paint_scale * 16), {c[0], c[1], c[2]}, -1, cv::LINE_AA, 4);
    }
  });
  strokes(skin, 0.22, [&](cv::Mat3b& bytes) {
    for (int i = 0; i < 4200; ++i) {
      const double y = random.uniform(182, 250), x = centre_x + random.uniform(-1, 1) * (half_width(y) + 2);
      const double off = std::abs(x - centre_x);
      const double beard = std::max(ramp(190, 222, y - 0.25 * (off - 30)), 0.9 * bell(x, y, centre_x, 191, 15, 5));
      if (random.uniform() > beard * (1 - 0.8 * bell(x, y, centre_x, 217, 8, 3))) continue;
      stroke(bytes, {x, y}, {x + 0.1, y + 0.5}, {x + random.uniform(-0.4, 0.4), y + 1.1}, rgb(72, 54, 48), 0.3);
    }
  });
}

void paint_lips(Picture& skin, Random& random) {
  const auto colour = [&](bool upper, Colour tone) {
    Picture lip(height, width, tone);
    mix(skin, fill(lip_outline(upper), 0.8), lip);
  };
  colour(true, rgb(186, 98, 92));
  colour(false, rgb(206, 116, 108));
  strokes(skin, 0.20, [&](cv::Mat3b& bytes) {
    for (int i = 0; i < 120; ++i) {
      const double u = random.uniform(-0.92, 0.92), x = centre_x + u * mouth_half_width, y = lip_line(x),
                   envelope = std::sqrt(1 - u * u);
      const bool upper = i % 2 == 0;
      const double to = y + (upper ? -6.5 : 8.5) * envelope * random.uniform(0.5, 0.95);
      stroke(bytes, {x, y}, {x + 0.6 * u, (y + to) / 2}, {x + 2 * u, to},
             random.uniform() < 0.6 ? rgb(142, 66, 64) : rgb(232, 156, 148), 0.35);
    }
  });
}

/// What is dark whatever the light: lines of lids, lips, nostrils.
void paint_lines(Picture& picture) {
  shade(picture, plane_of([](double x, double y) {
          const double u = (x - centre_x) / mouth_half_width;
          return std::abs(u) < 1.12
                     ? std::exp(-0.5 * std::pow((y - lip_line(x)) / 0.9, 2)) * (1 - 0.5 * ramp(0.9, 1.12, std::abs(u)))
                     : 0.0;
        }),
        -0.62);
  shade(picture, plane_of([](double x, double y) { return bells(x, y, 6.4, 177.4, 2.8, 1.3); }), -0.72);
  shade(picture, plane_of([](double x, double y) {
          return 0.7 * bell(x, y, centre_x, 182, 11, 2.6) + 0.5 * bell(x, y, centre_x + 15, 176, 3, 5);
        }),
        -0.20);
  shade(picture, plane_of([](double x, double y) {
          const double v = (std::abs(x - centre_x) - eye_distance) / eye_half_width;
          const double crease = 124.5 + 5.5 * v * v;
          return std::abs(v) < 1.15
                     ? std::exp(-0.5 * std::pow((y - crease) / 1.3, 2)) * (1 - ramp(0.8, 1.15, std::abs(v)))
                     : 0.0;
        }),
        -0.34);
  shade(picture, plane_of([](double x, double y) {
          const double v = (std::abs(x - centre_x) - eye_distance) / eye_half_width;
          return std::abs(v) < 1.05 ? std::exp(-0.5 * std::pow((y - lid_line(x)) / 0.8, 2)) : 0.0;
        }),
        -0.55);
  shade(picture, plane_of([](double x, double y) {
          const double t = (y - 178) / 24, off = 17 + 15 * t;
          return t > 0 && t < 1.1
                     ? std::exp(-0.5 * std::pow((std::abs(x - centre_x) - off) / 1.7, 2)) * std::sin(3.14159 * t / 1.1)
                     : 0.0;
        }),
        -0.10);
}

void paint_brows(Picture& picture, Random& random) {
  strokes(picture, 0.80, [&](cv::Mat3b& bytes) {
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < 260; ++i) {
        const double t = random.uniform();  // from the nose outwards
        const double middle = 108.5 - 5.5 * std::sin(2.3 * t) + 6.5 * t * t,
                     thick = 3.4 * (1 - 0.72 * t) * (0.6 + 0.4 * ramp(0, 0.15, t));
        const double x = centre_x + side * (16 + 37 * t), y = middle + thick * random.uniform(-1, 1);
        const double length = random.uniform(3, 5.5), lean = 0.9 - 1.0 * t;
        stroke(bytes, {x, y}, {x + side * 0.5 * length, y - 0.6 * lean * length},
               {x + side * length, y - lean * 0.7 * length + 0.6},
               rgb(58, 40, 30) * static_cast<float>(random.uniform(0.7, 1.5)), 0.35);
      }
  });
}

/// On the skull, `angle` from the top clockwise; 1 is the outline of the hair.
Point crown(double angle, double out) {
  return {centre_x + 78 * out * std::sin(angle), 112 - 95 * out * std::cos(angle)};
}

void paint_hair(Picture& picture, Random& random) {
  Outline right;
  for (double angle = 0; angle < 1.6; angle += 0.05) right.push_back(crown(angle, 0.985));
  for (const auto& [off, y] :
       {std::pair(69.0, 136.0), {66.5, 136}, {65, 118}, {62, 94}, {56, 74}, {40, 62}, {18, 57}, {0, 57}})
    right.emplace_back(centre_x + off, y);
  const Outline mass = rounded(mirrored(right));
  const auto shadow = rounded(mirrored({{centre_x, 46},
                                        {centre_x + 44, 50},
                                        {centre_x + 66, 76},
                                        {centre_x + 70, 136},
                                        {centre_x + 63, 136},
                                        {centre_x + 57, 90},
                                        {centre_x + 42, 70},
                                        {centre_x, 64}}));
  shade(picture, fill(shadow, 4), -0.30);
  mix(picture, fill(mass, 1.2), rgb(46, 32, 25));
  strokes(picture, 0.92, [&](cv::Mat3b& bytes) {
    for (int i = 0; i < 3400; ++i) {
      // A parting on the left: hair of the crown sweeps right, at the sides it falls.
      const double angle = random.uniform(-1.66, 1.66), out = random.uniform(0, 1);
      const Point root = crown(angle, 1.01 - (0.29 + 0.11 * std::cos(angle)) * (1 - out));
      const double sweep = angle > -0.55 + 0.05 * random.normal() ? 1 : -1;
      const double down = ramp(0.5, 1.4, std::abs(angle));
      const double length = random.uniform(7, 19) * (1 - 0.62 * ramp(1.15, 1.55, std::abs(angle)));
      const Point along(sweep * std::cos(angle) * (1 - down) + (angle > 0 ? 0.10 : -0.10) * down,
                        sweep * std::sin(angle) * (1 - down) * 0.9 + down);
      const Point tip =
          root + length * along * (0.55 + 0.45 * (1 - down)) + Point(random.normal(), random.normal()) * 1.0;
      const Point bend = 0.5 * (root + tip) + Point(0, -2.2 * (1 - down));
      const double shine =
          std::exp(-0.5 * std::pow((angle + 0.55) / 0.45, 2)) * std::exp(-0.5 * std::pow((out - 0.55) / 0.25, 2));
      const double light = random.uniform(0.55, 1.25) + 1.0 * shine - 0.25 * ramp(0.2, 1.5, angle);
      stroke(bytes, root, bend, tip, rgb(72, 50, 37) * static_cast<float>(light), 0.4);
    }
  });
}

cv::Mat to_bytes(const Picture& picture) {
  cv::Mat bytes;
  picture.convertTo(bytes, CV_8U, 255);
  return bytes;
}

/// A small picture with transparency: f gives colour and coverage at (x, y)
/// in units from its centre.
template <class F>
cv::Mat paint_part(double half_x, double half_y, F f) {
  const int columns = static_cast<int>(2 * half_x * part_scale), rows = static_cast<int>(2 * half_y * part_scale);
  cv::Mat4b part(rows, columns);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto [colour, cover] = f((c + 0.5) / part_scale - half_x, (r + 0.5) / part_scale - half_y);
      for (int k = 0; k < 3; ++k) part(r, c)[k] = cv::saturate_cast<uchar>(255 * colour[k]);
      part(r, c)[3] = cv::saturate_cast<uchar>(255 * cover);
    }
  return part;
}

struct Dab {
  Colour colour;
  double cover;
};

/// Teeth on an arch. `half_widths` from the middle outwards; `length` of the crowns; `up` for the lower row.
cv::Mat paint_teeth(const std::vector<double>& widths, const std::vector<double>& lengths, bool lower, double warmth) {
  return paint_part(26, 10, [&](double x, double y) -> Dab {
    const double sign = lower ? -1 : 1;
    double edge = 0, from = 0;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const double to = from + widths[i];
      if (std::abs(x) < to) {
        const double t = (std::abs(x) - from) / widths[i] * 2 - 1;  // -1 to 1 across this tooth
        edge = lengths[i] - 0.5 * std::pow(std::abs(t), 4) - 0.12 * x * x / 26;
        const double gap = std::exp(-0.5 * std::pow((1 - std::abs(t)) * widths[i] / 2 / 0.16, 2));
        const double arch = 1 - std::pow(std::abs(x) / 25, 2.2) * 0.75;
        const double height = sign * y;  // grows towards the biting edge
        const double root = ramp(-5, 2, height);
        const double light = (0.62 + 0.30 * root) * arch * (1 - 0.16 * gap) * (1 - 0.10 * t * t) * (1 - 0.05 * (x > 0));
        const Colour tone = rgb(238, 230 - 6 * warmth, 212 - 16 * warmth) * static_cast<float>(light);
        return {tone, 1 - ramp(edge - 0.25, edge + 0.25, height)};
      }
      from = to;
    }
    return {rgb(90, 30, 30), 0};
  });
}

}  // namespace

cv::Mat paint_portrait(std::uint64_t seed) {
  Random random(seed, "speaker.builtin", "portrait");
  Picture picture(height, width);
  const auto grain = noise(0.9, random);
  paint_background(picture, random);
  paint_neck(picture, grain);
  paint_shoulders(picture, random);
  paint_ears(picture);
  auto skin = paint_skin(grain, random);
  paint_freckles(skin, random);
  paint_lips(skin, random);
  illuminate(skin, light_on(plane_of(relief)), 0.16);
  mix(picture, fill(face_outline(), 0.6), skin);
  paint_lines(picture);
  paint_brows(picture, random);
  paint_hair(picture, random);
  cv::GaussianBlur(picture, picture, {}, 0.75);
  return to_bytes(picture);
}

cv::Mat paint_upper_teeth() {
  return paint_teeth({4.4, 3.5, 3.8, 3.4, 3.2, 3.0}, {4.6, 4.1, 4.5, 3.9, 3.5, 3.2}, false, 0);
}
cv::Mat paint_lower_teeth() {
  return paint_teeth({2.8, 3.0, 3.4, 3.2, 3.2, 3.2}, {4.0, 4.1, 4.2, 3.9, 3.7, 3.5}, true, 0.8);
}

cv::Mat paint_tongue(std::uint64_t seed) {
  Random random(seed, "speaker.builtin", "tongue");
  const auto grain = noise(1.0, random);
  return paint_part(20, 12, [&](double x, double y) -> Dab {
    const double r = std::pow(std::abs(x / 17), 2.4) + std::pow(std::abs(y / 10), 2.2);
    const double groove = 0.16 * std::exp(-0.5 * x * x / 1.5) * ramp(-8, 2, y);
    const double light = 0.92 - 0.30 * r - 0.10 * y / 10 - groove +
                         0.18 * std::exp(-0.5 * (std::pow((x + 5) / 4, 2) + std::pow((y + 4) / 2, 2)));
    const int row = static_cast<int>((y + 60) * paint_scale), column = static_cast<int>((x + 60) * paint_scale);
    return {rgb(198, 96, 98) * static_cast<float>(light + 0.03 * grain(row, column)), 1 - ramp(0.86, 1.0, r)};
  });
}

cv::Mat paint_eyeball(std::uint64_t seed) {
  Random random(seed, "speaker.builtin", "eyeball");
  const auto grain = noise(2.5, random);
  return paint_part(18, 12, [&](double x, double y) -> Dab {
    const double r = std::hypot(x / 17, (y - 1) / 13);
    const double light = 1.0 - 0.42 * r * r;
    const double pink = 0.35 * ramp(8, 15, std::abs(x));
    const int row = static_cast<int>((y + 60) * paint_scale), column = static_cast<int>((x + 60) * paint_scale);
    return {rgb(226, 220 - 40 * pink, 214 - 48 * pink) * static_cast<float>(light + 0.012 * grain(row, column)), 1};
  });
}

cv::Mat paint_iris(std::uint64_t seed) {
  Random random(seed, "speaker.builtin", "iris");
  std::array<double, 48> spokes{};
  for (double& s : spokes) s = random.uniform(-1, 1);
  return paint_part(9, 9, [&](double x, double y) -> Dab {
    const double r = std::hypot(x, y), angle = (std::atan2(y, x) + 3.141592653589793) / 6.283185307179586 * 48;
    const auto i = static_cast<std::size_t>(angle) % 48;
    const double t = angle - std::floor(angle), spoke = spokes[i] * (1 - t) + spokes[(i + 1) % 48] * t;
    Colour c = rgb(92, 116, 128) * static_cast<float>(0.80 + 0.26 * spoke + 0.28 * ramp(-3, 5, y));
    c += (rgb(128, 96, 60) - c) * static_cast<float>(0.65 * (1 - ramp(2.6, 4.4, r)));
    c *= static_cast<float>(1 - 0.72 * ramp(5.0, 6.4, r));
    c += (rgb(12, 10, 10) - c) * static_cast<float>(1 - ramp(2.2, 2.8, r));
    const double glint = 1 - ramp(0.9, 1.5, std::hypot(x + 2.1, y + 2.3)),
                 second = 0.35 * (1 - ramp(0.6, 1.2, std::hypot(x - 1.8, y - 2.0)));
    c += (rgb(255, 255, 255) - c) * static_cast<float>(std::max(glint, second));
    return {c, 1 - ramp(6.1, 6.7, r)};
  });
}

}  // namespace talkgraph::face
