#include "nodes/face/report.h"

#include <cmath>
#include <stdexcept>

#include "nodes/face/geometry.h"
#include "nodes/face/reconstruct.h"

namespace talkgraph {
namespace {

/// Mean squares over a set of pictures, and the worst of them.
struct Measured {
  double pictures = 0;
  double shape = 0, texture = 0, combined = 0;  ///< share of the variance about the model's means that its modes keep
  double landmarks = 0, grey = 0, noise = 0;    ///< squared errors; noise is that of the picture, 255 = 1
  double worst_landmarks = 0, worst_grey = 0, worst_psnr = 100;
};

double share(double part, double whole) { return whole > 0 ? part / whole : NAN; }

Measured measure(const AppearanceModel& model, const Prototypes& pictures, const Context& context) {
  const Eigen::VectorXd mean_shape = flatten(model.mean_shape);
  const Eigen::VectorXf mean_texture = model.levels.at(0).mean->col(0);
  const auto shape_modes = model.shape_modes.cols(), texture_modes = model.texture_modes->cols();
  Measured out;
  double shape = 0, texture = 0, combined = 0;
  for (std::size_t i = 0; i < pictures.images.size(); ++i) {
    context.check_cancelled();
    const auto r = reconstruct(model, pictures.images[i].pixels, pictures.shapes[i]);
    out.pictures += 1;
    shape += (r.aligned - mean_shape).squaredNorm();
    texture += static_cast<double>((r.texture - mean_texture).squaredNorm());
    combined += r.reduced.squaredNorm();
    out.shape += r.reduced.head(shape_modes).squaredNorm() / (model.shape_weight * model.shape_weight);
    out.texture += r.reduced.tail(texture_modes).squaredNorm();
    out.combined += r.c.squaredNorm();
    out.landmarks += r.landmarks * r.landmarks;
    out.grey += r.texture_error * r.texture_error;
    out.noise += std::pow(10, -r.psnr / 10);
    out.worst_landmarks = std::max(out.worst_landmarks, r.landmarks);
    out.worst_grey = std::max(out.worst_grey, r.texture_error);
    out.worst_psnr = std::min(out.worst_psnr, r.psnr);
  }
  if (out.pictures == 0) throw std::runtime_error("a face model cannot be judged without pictures");
  out.shape = share(out.shape, shape);
  out.texture = share(out.texture, texture);
  out.combined = share(out.combined, combined);
  for (double* v : {&out.landmarks, &out.grey, &out.noise}) *v /= out.pictures;
  return out;
}

std::vector<double> error_row(const Measured& m) {
  return {m.pictures,        std::sqrt(m.landmarks), std::sqrt(m.grey), -10 * std::log10(m.noise),
          m.worst_landmarks, m.worst_grey,           m.worst_psnr};
}

Table mode_table(const AppearanceModel& model, const Measured& training) {
  const std::vector<std::pair<Eigen::VectorXd, double>> stages = {{model.shape_variances, training.shape},
                                                                  {model.texture_variances, training.texture},
                                                                  {model.combined_variances, training.combined}};
  Table table{"Share of the variance, mode by mode",
              "mode",
              {"shape", "shape kept", "texture", "texture kept", "combined", "combined kept"},
              {},
              {}};
  Eigen::Index most = 0;
  for (const auto& [variances, kept] : stages) most = std::max(most, variances.size());
  for (Eigen::Index k = 0; k < most; ++k) {
    table.rows.push_back(std::to_string(k + 1));
    auto& row = table.cells.emplace_back();
    for (const auto& [variances, kept] : stages) {
      const bool there = k < variances.size();
      row.push_back(there ? kept * variances(k) / variances.sum() : NAN);
      row.push_back(there ? kept * variances.head(k + 1).sum() / variances.sum() : NAN);
    }
  }
  return table;
}

}  // namespace

FaceReport::Out FaceReport::operator()(const AppearanceModel& model, const Prototypes& training,
                                       const Prototypes& unseen, Context& context) const {
  const auto seen = measure(model, training, context), other = measure(model, unseen, context);
  const auto row = [](const Eigen::VectorXd& variances, double kept) {
    return std::vector<double>{static_cast<double>(variances.size()), kept};
  };
  return {{"Modes of each stage",
           "stage",
           {"modes", "variance kept"},
           {"shape", "texture", "combined"},
           {row(model.shape_variances, seen.shape), row(model.texture_variances, seen.texture),
            row(model.combined_variances, seen.combined)}},
          mode_table(model, seen),
          {"Reconstruction from the model's parameters",
           "pictures",
           {"pictures", "landmarks px", "texture grey", "PSNR dB", "worst landmarks px", "worst texture grey",
            "worst PSNR dB"},
           {"built from", "unseen"},
           {error_row(seen), error_row(other)}}};
}

void describe(Description<FaceReport>& d) {
  d.type("face.report")
      .version(1)
      .summary("what a face model keeps, and how well it shows pictures it was not built from")
      .source("docs/method.md §2");
  d.input("model", "of the face")
      .input("training", "the prototypes it was built from")
      .input("unseen", "pictures with landmarks of clips not trained on")
      .output("stages", &FaceReport::Out::stages,
              "modes of shape, texture and both, and the share of variance they hold")
      .output("modes", &FaceReport::Out::modes, "share of the variance of each mode, and of all up to it")
      .output("errors", &FaceReport::Out::errors, "landmarks, texture and PSNR of both sets of pictures");
}

}  // namespace talkgraph
