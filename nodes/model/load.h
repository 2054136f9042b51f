#pragma once

#include "graph/description.h"
#include "nodes/model/talking_face.h"

namespace talkgraph {

/// Reads a talking face that `model.save` wrote, in its parts. Throws
/// std::runtime_error if the file is missing, foreign or damaged.
struct LoadModel {
  FilePath file;

  TalkingFace operator()() const;
};
void describe(Description<LoadModel>& d);

}  // namespace talkgraph
