// The kept-alive child of a worker: tasks in, reports out, one JSON object a line each, until the pipe closes or SIGTERM comes.
#pragma once

namespace fracfarm {

// Returns an ExitCode: 0 after the end of input or a stop, 1 where the pipe broke.
int serve();

}  // namespace fracfarm
