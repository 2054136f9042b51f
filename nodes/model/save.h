#pragma once

#include "graph/description.h"
#include "nodes/model/talking_face.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a talking face to one HDF5 file, with the graph that speaks with it and the one that made it.
struct SaveModel {
  std::string name = "model.h5";  ///< file below the run folder
  GraphText speak;                ///< graph with the nodes `recordings` and `model`, which `talkgraph speak` sets

  /// Throws std::invalid_argument if nothing is given that could move the face.
  Artifact operator()(const AppearanceModel& face, const BaseClip& base, const Vlmm& contexts, const Ssgpdm* states,
                      const ContextGp* process, const Track& mean, const Mouths* mouths, const Provenance& made,
                      Context& context) const;
};
void describe(Description<SaveModel>& d);

/// The format marker in every model file.
inline constexpr const char* model_format = "talkgraph model 5";

/// Throws std::runtime_error if the file is missing, foreign or damaged.
TalkingFace load_model(const std::string& file);

/// Only the graph that speaks with a model, resolved, as JSON.
std::string model_graph(const std::string& file);

}  // namespace talkgraph
