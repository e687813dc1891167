#pragma once

namespace maximin::apps {

/// Whether standard output is a terminal: a person reads along.
bool stdout_is_terminal();

/// Whether standard error is a terminal that can redraw a line: progress may be shown there.
bool stderr_is_terminal();

/// Columns of the terminal that standard error is on; 80 where that cannot be told.
int terminal_width();

}  // namespace maximin::apps
