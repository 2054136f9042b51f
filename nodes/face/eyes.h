#pragma once

#include "graph/description.h"
#include "graph/random.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/eyes.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Where a drawn face's eyes come from.
enum class EyeSource { base, still, blinking, given };
template <>
inline constexpr EnumNames<EyeSource, 4> enum_names<EyeSource>{{{EyeSource::base, "base"},
                                                                {EyeSource::still, "still"},
                                                                {EyeSource::blinking, "blinking"},
                                                                {EyeSource::given, "given"}}};

/// Eyes for a face of appearance parameters: as they are without this node (base: those of the frames drawn upon),
/// those of the mean parameters, the same with lids that blink now and then, or those of other parameters (the recorded
/// ones, say) at the same time, whatever their rate, held at their ends where they are shorter. Shut eyes are the
/// likeliest ones of the model, given that the lids are `reach` standard deviations nearer to each other than on
/// average, or meet before. Blinks come `interval` apart on average, no nearer than half of it, and the same seed gives
/// the same ones. Thesis §6.3.5. Throws std::runtime_error if parameters were made with another model, `given` is asked
/// for and not there or without a frame, the model lacks a point, or blinking is asked of a model whose lids never
/// move.
struct MakeEyes {
  EyeSource source = EyeSource::base;
  double interval = 3.5;  ///< between blinks, seconds
  double duration = 0.3;  ///< of a blink, seconds
  double reach = 4;       ///< of shutting lids, standard deviations of the gap between them

  std::vector<int> points;      ///< of the eyes; empty: they, the nose and the lids are the point scheme's
  std::vector<int> nose;        ///< carried along with the eyes
  std::vector<int> upper_lids;  ///< from corner to corner
  std::vector<int> lower_lids;  ///< below those, in their order

  Eyes operator()(const AppearanceModel& model, const Track& parameters, const Track* given, Random& random) const;
};
void describe(Description<MakeEyes>& d);

/// Rows of a face in which its eyes are replaced: an eighth of the distance across them above and below their points,
/// beyond which they fade out.
struct EyeBand {
  double top, bottom, fade;
};
EyeBand eye_band(const Shape& face, const std::vector<int>& eyes);

/// The row of the mean shape below which nothing of the eyes is seen. Throws std::runtime_error if the model's point
/// scheme is unknown or says nothing of where they are.
double below_eyes(const AppearanceModel& model);

/// How far lids are shut, 0 to 1, `since` seconds after a blink's begin: a third of its duration down, the rest up.
double lid_closure(double since, double duration);

}  // namespace talkgraph
