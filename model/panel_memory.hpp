#pragma once

#include <memory>

#include "model/garment.hpp"
#include "model/memory/term_memory.hpp"

namespace drape::model {

/// What a force of a panel remembers, told of nodes instead of the panel's particles. The panel outlives it.
std::shared_ptr<TermMemory> of_nodes(std::shared_ptr<TermMemory> memory, const Garment::Panel& panel);

}  // namespace drape::model
