#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a value of any type as HDF5, below the run folder: FOLDER/NODE.h5, those of a stream as FOLDER/NODE/ITEM.h5,
/// NODE being the name of this node in the graph. The members are laid out as write_hdf5 (graph/archive.h) says; the
/// file has the attributes type, type_version, item, made_by, node and provenance. Errors: the file cannot be written.
struct WriteHdf5 {
  std::string folder = "hdf5";

  Artifact operator()(const Value& value, const Provenance& made, Context& context) const;
};
void describe(Description<WriteHdf5>& d);

}  // namespace talkgraph
