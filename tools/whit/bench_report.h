// What `whit bench` says of its measurements, in words and as JSON.
#pragma once

#include "tools/whit/bench_ingestion.h"
#include "tools/whit/bench_measure.h"
#include "tools/whit/json.h"

namespace whit {

/// The line above the rows of scenes.
void print_heading(int runs);
void print_row(const SceneFigures& figures);
void print_ingestion(const Ingestion& ingestion);

Json to_json(const SceneFigures& figures);
Json to_json(const Ingestion& ingestion);

}  // namespace whit
