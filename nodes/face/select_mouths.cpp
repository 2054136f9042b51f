#include "nodes/face/select_mouths.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "nodes/face/mouth_region.h"
#include "nodes/face/shapes.h"
#include "nodes/types/best_path.h"

namespace talkgraph {
namespace {

/// The nearest mouths of every frame, T × n, and their squared distances.
struct Near {
  Eigen::Matrix<Eigen::Index, Eigen::Dynamic, Eigen::Dynamic> mouth;
  Eigen::MatrixXd distance;
};

Near nearest(const Eigen::MatrixXd& wanted, const Eigen::MatrixXd& kept, Eigen::Index count) {
  Near near{{wanted.cols(), count}, {wanted.cols(), count}};
  std::vector<Eigen::Index> order(static_cast<std::size_t>(kept.cols()));
  for (Eigen::Index t = 0; t < wanted.cols(); ++t) {
    const Eigen::RowVectorXd distance = (kept.colwise() - wanted.col(t)).colwise().squaredNorm();
    std::iota(order.begin(), order.end(), 0);
    std::partial_sort(order.begin(), order.begin() + count, order.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::pair(distance(a), a) < std::pair(distance(b), b);
    });
    for (Eigen::Index i = 0; i < count; ++i) {
      near.mouth(t, i) = order[static_cast<std::size_t>(i)];
      near.distance(t, i) = distance(near.mouth(t, i));
    }
  }
  return near;
}

/// Real mouths side by side.
struct Textures {
  Textures(const AppearanceModel& model, const Mouths& mouths, const Near& near, Eigen::Index t)
      : columns(3 * mouths.pictures.front().pixels.total(), near.mouth.cols()) {
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      const cv::Mat& picture = mouths.pictures[static_cast<std::size_t>(near.mouth(t, i))].pixels;
      cv::Mat column(picture.size(), CV_32FC3, columns.col(i).data());
      picture.convertTo(column, CV_32FC3, 1 / model.texture_gain);
    }
    sizes = columns.colwise().squaredNorm().cast<double>();
  }
  Eigen::MatrixXf columns;   ///< normalised textures of the mouths near those of frame t, one each
  Eigen::RowVectorXd sizes;  ///< squared norms
};

}  // namespace

MouthTrack SelectMouths::operator()(const AppearanceModel& model, const Mouths& mouths, const Track& parameters) const {
  check_dimension(model, parameters);
  MouthTrack out{mouths, {}};
  if (mouths.size() == 0 || parameters.frames() == 0) return out;
  const auto region = mouth_region(model, mouths.points, mouths.margin);
  check_mouths(model, region, mouths);
  if (!parameters.values.allFinite())
    throw std::runtime_error("the appearance parameters hold a value that is not a number");
  const auto metric = mouth_metric(model, region, mouths.points);
  const auto near = nearest(metric * parameters.values.transpose(), metric * mouths.parameters.transpose(),
                            std::min<Eigen::Index>(candidates, mouths.size()));
  Textures before(model, mouths, near, 0);
  const auto scores = [&](Eigen::Index t) -> Eigen::VectorXd { return -near.distance.row(t); };
  const auto steps = [&](Eigen::Index t) -> Eigen::MatrixXd {
    Textures now(model, mouths, near, t);
    const Eigen::MatrixXd likeness = (before.columns.transpose() * now.columns).cast<double>();
    Eigen::MatrixXd step = smoothness * (((-2 * likeness).rowwise() + now.sizes).colwise() + before.sizes.transpose());
    before = std::move(now);
    return -step.cwiseMax(0);
  };
  for (const Eigen::Index state : best_path(parameters.frames(), scores, steps).states)
    out.chosen.push_back(near.mouth(static_cast<Eigen::Index>(out.chosen.size()), state));
  return out;
}

void describe(Description<SelectMouths>& d) {
  d.type("face.select_mouths")
      .version(1)
      .summary("the sequence of real mouths that follows synthesised appearance parameters most closely")
      .source("after Wang, Qian, Han & Soong 2010; docs/method.md §2");
  d.input("model", "of the face")
      .input("mouths", "to choose from; none: the face stays as the model draws it")
      .input("parameters", "appearance parameters c")
      .output("mouths", "one for every frame");
  d.param("smoothness", &SelectMouths::smoothness)
      .at_least(0)
      .doc("weight of the difference between the mouths of consecutive frames against that from the parameters");
  d.param("candidates", &SelectMouths::candidates).at_least(1).doc("nearest mouths among which a frame's is chosen");
}

}  // namespace talkgraph
