#pragma once

#include "graph/description.h"
#include "nodes/plot/latent_space.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes the latent space of a model as a page to turn and zoom in: points and paths in three dimensions, coloured by
/// what is said, in a cloud that is the darker the surer the model is there (thesis Figures 5.9 to 5.12). One HTML file
/// that needs no other and no network; mouse, touch and keyboard work, and a table tells the same in numbers.
/// Inputs and errors are those of plot.latent; a model of fewer than three dimensions is drawn over the frames of its
/// windows. A file that cannot be written is an error as well.
struct LatentPage {
  std::string state;            ///< label; empty: the one with most frames, if possible of several phones
  std::string process;          ///< whose precision is the cloud; empty: the face's, or the only one observed
  std::vector<int> dimensions;  ///< three, from 1; empty: the most relevant
  int resolution = 22;          ///< places of the cloud along each axis
  std::string title;            ///< empty: the state's label and size
  std::string name = "latent-space";

  Artifact operator()(const Value& model, const Collected<FrameLabels>& labels, const Collected<Track>& paths,
                      const Collected<SegmentTrack>& states, Context& context) const;
};
void describe(Description<LatentPage>& d);

}  // namespace talkgraph
