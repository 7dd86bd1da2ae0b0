// Every row of the table. Each function adds its own.
#pragma once

#include "scenes.h"
#include "table.h"

#include <vector>

namespace benchmarks
{

/// Pictures against those of VTK's CPU mapper.
void add_render_rows(Scenes& scenes, std::vector<Row>& rows);
/// Against the machine: threads, fetches.
void add_machine_rows(Scenes& scenes, std::vector<Row>& rows);
/// Light in a medium.
void add_light_rows(Scenes& scenes, std::vector<Row>& rows);
/// Effects, one by one, and left out.
void add_effect_rows(Scenes& scenes, std::vector<Row>& rows);
/// Large and sparse volumes, and memory.
void add_memory_rows(Scenes& scenes, std::vector<Row>& rows);
/// Noise, clouds dense and sparse.
void add_generator_rows(Scenes& scenes, std::vector<Row>& rows);
/// The window of `brume view`.
void add_view_rows(Scenes& scenes, std::vector<Row>& rows);

}
