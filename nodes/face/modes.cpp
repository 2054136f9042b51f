#include "nodes/face/modes.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "nodes/face/render.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {

Artifact FaceModes::operator()(const AppearanceModel& model, Context& context) const {
  const auto rows = std::max<Eigen::Index>(1, std::min<Eigen::Index>(modes, model.modes()));
  std::vector<cv::Mat> lines;
  for (Eigen::Index mode = 0; mode < rows; ++mode) {
    std::vector<cv::Mat> line;
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      Eigen::VectorXd c = Eigen::VectorXd::Zero(model.modes());
      if (mode < model.modes()) c(mode) = share * deviations * std::sqrt(model.combined_variances(mode));
      line.push_back(draw_face(model, c, 1.5, 255));
    }
    lines.emplace_back();
    cv::hconcat(line, lines.back());
  }
  cv::Mat sheet;
  cv::vconcat(lines, sheet);
  const Artifact artifact{name + ".png", "modes of the face model"};
  write_picture(context.file(artifact.path), sheet);
  return artifact;
}

void describe(Description<FaceModes>& d) {
  d.type("face.modes")
      .version(1)
      .summary("the modes of variation of a face model, as a picture")
      .source("Thesis Appendix B")
      .sink();
  d.input("model", "of the face").output("picture", "a PNG file");
  d.param("modes", &FaceModes::modes).at_least(1).doc("rows: the modes of the largest variance");
  d.param("deviations", &FaceModes::deviations).positive().doc("standard deviations shown each way");
  d.param("name", &FaceModes::name).doc("of the file below the run folder, without .png");
}

}  // namespace talkgraph
