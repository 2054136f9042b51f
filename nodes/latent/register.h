#pragma once

#include "graph/registry.h"

namespace talkgraph {

/// Adds the node types of this family: latent.gp, latent.gp_predict, latent.gpdm, latent.mrd, latent.sgpdm.
void register_latent(Registry& registry);

}  // namespace talkgraph
