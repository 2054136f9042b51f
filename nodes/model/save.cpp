#include "nodes/model/save.h"

#include <filesystem>
#include <stdexcept>

namespace talkgraph {

Artifact SaveModel::operator()(const AppearanceModel& face, const BaseClip& base, const Vlmm& contexts,
                               const Ssgpdm* states, const ContextGp* process, const Track& mean, const Mouths* mouths,
                               const Provenance& made, Context& context) const {
  if (!states && !process)
    throw std::invalid_argument("nothing moves the face: wire states (mapping.ssgpdm) or process (mapping.context_gp)");
  TalkingFace all{face, base, contexts, {}, {}, mean, mouths ? *mouths : Mouths{}, speak.json};
  if (states) all.states = *states;
  if (process) all.process = *process;
  std::string format = model_format;
  write_hdf5(context.file(name), [&](Archive& ar) {
    note(ar, made);
    ar("format", format);
    ar("model", all);
  });
  return {name, "trained model"};
}

void describe(Description<SaveModel>& d) {
  d.type("model.save").summary("writes a talking face, with the graph that speaks with it, to one HDF5 file").sink();
  d.input("face", "the face model")
      .input("base", "what synthesised faces are drawn upon")
      .input("contexts", "phonetic contexts")
      .input("states", "the switching model, or")
      .input("process", "the process of soft contexts")
      .input("mean", "mean visual parameters, 1 x D")
      .input("mouths", "real mouths for the face to show");
  d.output("file", "the model file");
  d.param("name", &SaveModel::name).doc("file below the run folder");
  d.param("speak", &SaveModel::speak).doc("graph that speaks with the model; kept in the file, resolved");
}

namespace {

/// Opens a model file that is what it says.
std::unique_ptr<Archive> open_model(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw std::runtime_error(file + ": there is no such model file");
  auto ar = hdf5_reader(file);
  std::string format;
  try {
    (*ar)("format", format);
  } catch (const std::runtime_error&) {
    throw std::runtime_error(file + ": is an HDF5 file but not a talkgraph model");
  }
  if (format != model_format)
    throw std::runtime_error(file + ": has the format \"" + format + "\"; this program reads \"" + model_format + "\"");
  return ar;
}

struct GraphOnly {
  std::string speak;
};
void fields(Archive& ar, GraphOnly& g) { ar("speak", g.speak); }

}  // namespace

TalkingFace load_model(const std::string& file) {
  TalkingFace all;
  (*open_model(file))("model", all);
  return all;
}

std::string model_graph(const std::string& file) {
  GraphOnly only;
  (*open_model(file))("model", only);
  return only.speak;
}

}  // namespace talkgraph
