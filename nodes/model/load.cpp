#include "nodes/model/load.h"

#include "nodes/model/save.h"

namespace talkgraph {

TalkingFace LoadModel::operator()() const { return load_model(file.path); }

void describe(Description<LoadModel>& d) {
  d.type("model.load").summary("reads a trained talking face");
  d.output("face", &TalkingFace::face).output("base", &TalkingFace::base).output("contexts", &TalkingFace::contexts);
  d.output("states", &TalkingFace::states).output("mean", &TalkingFace::mean);
  d.param("file", &LoadModel::file).doc("model file written by model.save");
}

}  // namespace talkgraph
