#pragma once

#include <vector>

#include "graph/description.h"
#include "nodes/face/sampling.h"
#include "nodes/face/steepest_descent.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"

namespace talkgraph {

/// A place of the model in a picture, and how well it fits.
struct Fit {
  Eigen::VectorXd c;
  Pose pose;
  double gain = 0, offset = 0;  ///< photometric: picture = gain · texture + offset
  double error = 1;             ///< share of the texture's variance left unexplained, 0..1
  double residual = 0;          ///< RMS texture error, grey levels
  double detail = 0;            ///< correlation with the model once each colour's mean is gone: 0 on plain skin colour
};

/// Pose of small changes (a, b, x, y) in the model frame: [1+a, -b; b, 1+a], then the shift.
Pose small_pose(const Eigen::Vector4d& q);

/// Where the derivative of the texture by shape and pose comes from: measured once on the prototypes, or the
/// gradient of the model's own texture as it is. Steps are taken forward with either (docs/method.md §2).
enum class FitMethod { fixed_jacobian, inverse_compositional };
template <>
inline constexpr EnumNames<FitMethod, 2> enum_names<FitMethod>{
    {{FitMethod::fixed_jacobian, "fixed_jacobian"}, {FitMethod::inverse_compositional, "inverse_compositional"}}};

struct FitOptions {
  int iterations = 10;      ///< at most, per level
  double tolerance = 1e-3;  ///< relative gain under which a fit ends
  double limit = 4;         ///< of the parameters, standard deviations
  double reach = 0;         ///< if above 0, a doubtful fit is tried again from starts so far beside, half widths
};

/// Fits a model to pictures (Algorithm 1, docs/method.md §2). It refers to the model and keeps
/// what it works with, so that each thread needs its own; results depend on the arguments alone.
class Fitter {
 public:
  explicit Fitter(const AppearanceModel& model, FitMethod method = FitMethod::fixed_jacobian);

  /// At one level: δ = -R δg, steps 1, 1.5, 0.5, 0.25; it ends when no step lowers the error or the gain is below
  /// the tolerance.
  Fit fit(Pyramid& pyramid, std::size_t level, const Fit& start, const FitOptions& options = {});
  /// At all levels, the coarsest first. A fit is doubtful if its error is far above the model's own.
  Fit coarse_to_fine(Pyramid& pyramid, const Fit& start, const FitOptions& options = {});
  /// Fills in how well a fit fits at one level: everything but c and pose.
  void evaluate(Pyramid& pyramid, std::size_t level, Fit& fit);

 private:
  /// One level of the model: columns that span its textures and their changes, [mean, appearance, change].
  struct Level {
    Sampler sample;
    SteepestDescent descent;
    Eigen::MatrixXf columns;
    Eigen::MatrixXd gram;      ///< inner products of the columns
    Eigen::MatrixX3d colours;  ///< sum of each column over the pixels of a colour
    Eigen::VectorXd weights;   ///< of the columns in the texture at which the level is linearised
    Eigen::VectorXd along;     ///< products of that texture with the columns
    double size = 1;           ///< its squared norm
    Eigen::MatrixXd normal;    ///< JᵀJ, J blind to gain and offset
  };
  /// A picture's texture inside a shape.
  struct Seen {
    Eigen::VectorXf texture;
    double norm = 0;
    Eigen::VectorXd products;  ///< of the normalised texture with the level's columns
  };

  Fit descend(Pyramid& pyramid, Fit at, const FitOptions& options);
  Eigen::VectorXd weights(const Fit& fit) const;
  void look(Pyramid& pyramid, const Level& level, Fit& fit, Seen& seen) const;
  void linearise(Level& level, const Fit& at);
  void find_normal(Level& level, const Eigen::VectorXd& weights);
  Eigen::VectorXd step(const Level& level, const Fit& at, const Seen& seen) const;
  Fit moved(const Fit& from, const Eigen::VectorXd& step, double limit) const;

  const AppearanceModel& model_;
  FitMethod method_;
  Eigen::Index modes_, textures_;  ///< parameters c; columns of textures: 1 + modes
  double noise_;                   ///< variance of a value of the normalised texture that the model does not explain
  Eigen::MatrixXd jacobian_;       ///< J in terms of the columns, one a parameter (c and pose)
  std::vector<Level> levels_;
  Seen best_seen_, trial_seen_;
};

}  // namespace talkgraph
