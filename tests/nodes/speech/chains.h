#pragma once

#include "nodes/speech/all_pole.h"
#include "nodes/speech/bark.h"
#include "nodes/speech/cepstrum.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/loudness.h"
#include "nodes/speech/lpc.h"
#include "nodes/speech/lsf.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/rasta.h"
#include "nodes/speech/spectrum.h"

/// The chains of pipelines/fragments/features, as calls.
namespace talkgraph::test {

inline Spectrum spectrum(const Audio& audio, SpectrumKind kind, const Frame& frame = {}) {
  return ShortTimeSpectrum{.window = {}, .kind = kind}(frame(PreEmphasis{}(audio)));
}

inline Track mfcc(const Audio& audio, const Frame& frame = {}) {
  return Cepstrum{}(Mel{}(spectrum(audio, SpectrumKind::magnitude, frame)).track);
}

inline Track plp(const Audio& audio, const Frame& frame = {}) {
  const auto [track, bands] = Mel{}(spectrum(audio, SpectrumKind::power, frame));
  return AllPole{.edges = EdgeBands::added}(Loudness{.curve = EqualLoudness::htk}(track, bands));
}

inline Track plp_bark(const Audio& audio, const Frame& frame = {}) {
  const auto [track, bands] = Bark{}(spectrum(audio, SpectrumKind::power, frame));
  return AllPole{}(Loudness{}(track, bands));
}

inline Track rasta_plp(const Audio& audio, const Frame& frame = {}) {
  const auto [track, bands] = Bark{}(spectrum(audio, SpectrumKind::power, frame));
  return AllPole{}(Loudness{}(Rasta{}(track), bands));
}

inline Track lpc(const Audio& audio, const Frame& frame = {}) {
  return Lpc{.window = {}}(frame(PreEmphasis{}(audio))).lpc;
}

inline Track lsf(const Audio& audio, const Frame& frame = {}) {
  Context context;
  return Lsf{}(lpc(audio, frame), context);
}

inline Track reflection(const Audio& audio, const Frame& frame = {}) {
  Context context;
  return Reflection{}(lpc(audio, frame), context);
}

}  // namespace talkgraph::test
