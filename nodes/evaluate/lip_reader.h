#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/types/lip_reader.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class LipUnits { phones, visemes };
template <>
inline constexpr EnumNames<LipUnits, 2> enum_names<LipUnits>{
    {{LipUnits::phones, "phones"}, {LipUnits::visemes, "visemes"}}};

/// What is read of a phone: itself, its MPEG-4 viseme "1" to "14", or "sil" of a pause. Throws std::runtime_error on
/// what is no phone.
std::string lip_unit(const std::string& phone, bool visemes);

/// Learns to read lips: a left-to-right hidden Markov model of every phone or viseme (thesis §6.2.4; Hilder, Harvey &
/// Theobald 2009), of as many states as its runs have frames in the median, but at most `states`; ways lead on from a
/// state to all later ones of its unit, and out. By Baum-Welch on the runs of each unit, which lost frames end, from
/// runs cut evenly. From unit to unit by counts of neighbouring runs, each once more; adjoining runs of one unit are
/// one run. Throws std::runtime_error, naming the sequence, as measured_runs does, if lengths differ by more than two
/// frames, or on a label that is no phone.
struct TrainLipReader {
  LipUnits units = LipUnits::phones;
  int states = 3;
  int mixture = 1;
  double floor = 1e-2;
  int iterations = 20;
  double tolerance = 1e-4;

  LipReader operator()(const Collected<Track>& tracks, const Collected<FrameLabels>& labels, Random& random,
                       Context& context) const;
};
void describe(Description<TrainLipReader>& d);

}  // namespace talkgraph
