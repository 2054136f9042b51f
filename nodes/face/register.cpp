#include "nodes/face/register.h"

#include "nodes/face/base_clip.h"
#include "nodes/face/build.h"
#include "nodes/face/choose_base.h"
#include "nodes/face/composite.h"
#include "nodes/face/crop.h"
#include "nodes/face/eyes.h"
#include "nodes/face/landmarks.h"
#include "nodes/face/modes.h"
#include "nodes/face/mouth_space.h"
#include "nodes/face/mouths.h"
#include "nodes/face/parameters.h"
#include "nodes/face/prototype_sheet.h"
#include "nodes/face/prototypes.h"
#include "nodes/face/redraw.h"
#include "nodes/face/render.h"
#include "nodes/face/report.h"
#include "nodes/face/select_mouths.h"
#include "nodes/face/shapes.h"
#include "nodes/face/side_by_side.h"
#include "nodes/face/strip.h"
#include "nodes/face/track.h"

namespace talkgraph {

void register_face(Registry& registry) {
  registry.add<ChoosePrototypes>();
  registry.add<BuildAppearance>();
  registry.add<TrackFace>();
  registry.add<FaceParameters>();
  registry.add<FaceLandmarks>();
  registry.add<FaceShapes>();
  registry.add<MakeBaseClip>();
  registry.add<ChooseBase>();
  registry.add<CompositeFace>();
  registry.add<RenderFace>();
  registry.add<MakeEyes>();
  registry.add<KeepMouths>();
  registry.add<SelectMouths>();
  registry.add<LearnMouthSpace>();
  registry.add<MeasureMouth>();
  registry.add<RedrawFace>();
  registry.add<Crop>();
  registry.add<SideBySide>();
  registry.add<FrameStrip>();
  registry.add<FaceModes>();
  registry.add<FaceReport>();
  registry.add<PrototypeSheet>();
  registry.add<ModelSheet>();
}

}  // namespace talkgraph
