#include "nodes/model/load.h"

#include "nodes/model/save.h"

namespace talkgraph {

TalkingFace LoadModel::operator()() const { return load_model(file.path); }

void describe(Description<LoadModel>& d) {
  d.type("model.load").summary("reads a trained talking face");
  d.output("face", &TalkingFace::face, "the face model")
      .output("base", &TalkingFace::base, "what synthesised faces are drawn upon")
      .output("contexts", &TalkingFace::contexts, "phonetic contexts");
  d.output("states", &TalkingFace::states, "the switching model, if that is what moves the face")
      .output("process", &TalkingFace::process, "the process of soft contexts, if that is")
      .output("mean", &TalkingFace::mean, "mean visual parameters, 1 x D")
      .output("mouths", &TalkingFace::mouths, "real mouths for the face to show; may be none");
  d.param("file", &LoadModel::file).doc("model file written by model.save");
}

}  // namespace talkgraph
