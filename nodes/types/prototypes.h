#pragma once

#include <string>
#include <vector>

#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Pictures of a face with their landmarks, which an appearance model is built
/// from. Pictures are cut to the surroundings of the face.
struct Prototypes {
  std::vector<Image> images;
  std::vector<Shape> shapes;  ///< pixels of the picture beside it
  std::string scheme;         ///< name of the point scheme
};
template <>
inline constexpr PortType port_type<Prototypes>{"Prototypes", 1};
void fields(Archive& ar, Prototypes& p);

}  // namespace talkgraph
