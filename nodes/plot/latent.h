#pragma once

#include "graph/description.h"
#include "nodes/plot/axis.h"
#include "nodes/plot/latent_space.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// The latent points of a model in two dimensions, coloured by what is said, those of a window joined, before how sure
/// the model is of its predictions there: the lighter, the surer (thesis Figures 4.6 and 4.10). Of a switching model
/// it shows one state. `labels` say what is said (latent_phones()); `paths` are latent points that were synthesised,
/// as mapping.ssgpdm_synthesise gives them with its `states`.
///
/// A model of one dimension is drawn over the frames of its windows. Throws std::invalid_argument on an unknown state
/// or process and on dimensions that the model has not, std::runtime_error if labels or paths do not fit the model.
struct PlotLatent {
  std::string state;            ///< label; empty: the one with most frames, if possible of several phones
  std::string process;          ///< whose precision is shown; empty: the face's, or the only one observed
  std::vector<int> dimensions;  ///< two, from 1; empty: the most relevant
  int resolution = 80;          ///< places of the background along the picture
  std::string title;            ///< empty: the state's label and size

  Plot operator()(const Value& model, const Collected<FrameLabels>& labels, const Collected<Track>& paths,
                  const Collected<SegmentTrack>& states) const;
};
void describe(Description<PlotLatent>& d);

/// What such a picture shows, before it is drawn.
struct LatentPicture {
  std::vector<LatentAxis> axes;
  Axis x, y;                           ///< limits of the picture, distance of the ticks
  Eigen::MatrixXd points;              ///< N × 2
  std::vector<std::int64_t> lengths;   ///< of the windows
  PhoneColours phones;                 ///< of the points
  std::vector<Eigen::MatrixXd> paths;  ///< T × 2
  /// log_precision() at latents_at(): rows from the lower to the upper limit of y, columns along x.
  Eigen::MatrixXd background;
  std::string process;  ///< of the background
};
LatentPicture latent_picture(const PlotLatent& node, const LatentSpace& space, const Collected<FrameLabels>& labels,
                             const Collected<Track>& paths, const Collected<SegmentTrack>& states);
std::string draw_latent(const std::string& title, const LatentPicture& picture);

}  // namespace talkgraph
