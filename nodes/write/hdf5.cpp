#include "nodes/write/hdf5.h"

#include "nodes/types/item_file.h"

namespace talkgraph {

Artifact WriteHdf5::operator()(const Value& value, const Provenance& made, Context& context) const {
  const auto below = std::filesystem::path(folder) / (context.item.empty() ? "" : made.node);
  const Artifact artifact = item_file(context, below, ".h5", made.node);
  const PortType& type = value.type().type;
  write_hdf5(context.file(artifact.path), [&](Archive& ar) {
    ar.note("", "type", type.name);
    ar.note("", "type_version", type.version);
    ar.note("", "item", context.item);
    note(ar, made);
    // An archive that saves does not change what it visits.
    value.type().visit(ar, const_cast<void*>(value.data()));
  });
  return artifact;
}

void describe(Description<WriteHdf5>& d) {
  d.type("write.hdf5").summary("writes a value of any type as HDF5, for h5py and other readers").sink();
  d.input("value", "whatever is wired").output("file", "the HDF5 file");
  d.param("folder", &WriteHdf5::folder).doc("below the run folder");
}

}  // namespace talkgraph
