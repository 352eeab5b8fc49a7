#include "core/lobe/table.h"

namespace whit {

namespace {

constexpr const LobeRow* kRows[] = {
#define LOBE(name) &lobe_rows::name,
#include "core/lobe/lobe_types.inc"
#undef LOBE
};

}  // namespace

const LobeRow& row_of(LobeType type) { return *kRows[static_cast<size_t>(type)]; }

std::span<const LobeRow* const> all_rows() { return kRows; }

bool is_specular(LobeType type) { return row_of(type).specular; }

Effect effect_of(LobeType type) { return row_of(type).effect; }

}  // namespace whit
