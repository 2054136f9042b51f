#include "nodes/report/register.h"

#include "nodes/report/write.h"
#include "nodes/report/write_plot.h"
#include "nodes/report/write_table.h"
#include "nodes/report/write_track.h"

namespace talkgraph {

void register_report(Registry& registry) {
  registry.add<WriteReport>();
  registry.add<WritePlot>();
  registry.add<WriteTable>();
  registry.add<WriteTrack>();
}

}  // namespace talkgraph
