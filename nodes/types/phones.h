#pragma once

#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A labelled stretch of time, seconds.
struct Interval {
  std::string label;
  double start = 0;
  double end = 0;
};
template <>
inline constexpr bool is_row<Interval> = true;
void fields(Archive& ar, Interval& i);

/// Phones with their times, in order, without gaps or overlaps. Labels are
/// lower-case CMU phones without stress ("aa" ... "zh"), or BEEP phones, with
/// "sil" for silence and "breath" where a corpus labels it.
struct PhoneTrack {
  std::vector<Interval> phones;
};
template <>
inline constexpr PortType port_type<PhoneTrack>{"PhoneTrack", 1};
void fields(Archive& ar, PhoneTrack& p);

/// Words with their times, "sil" between them where a pause is known.
struct WordTrack {
  std::vector<Interval> words;
};
template <>
inline constexpr PortType port_type<WordTrack>{"WordTrack", 1};
void fields(Archive& ar, WordTrack& w);

/// What is said, as plain text.
struct Transcript {
  std::string text;
};
template <>
inline constexpr PortType port_type<Transcript>{"Transcript", 1};
void fields(Archive& ar, Transcript& t);

/// One label a video frame.
struct FrameLabels {
  std::vector<std::string> labels;
  Rational rate{25};
};
template <>
inline constexpr PortType port_type<FrameLabels>{"FrameLabels", 1};
void fields(Archive& ar, FrameLabels& l);

}  // namespace talkgraph
