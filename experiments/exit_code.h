// What the command `plumbline` tells the shell.
#pragma once

namespace plumb {

enum ExitCode : int {
    exit_fine = 0,
    exit_failed = 1,         // a threshold or a comparison failed
    exit_wrong_use = 2,      // wrong use or bad input
    exit_environment = 3,    // the environment lacks something
    exit_interrupted = 130,  // stopped by Ctrl-C; what was done is kept
};

}  // namespace plumb
