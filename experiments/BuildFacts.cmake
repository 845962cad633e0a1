# Script behind build_facts.cpp: writes OUTPUT anew where git's description of SOURCE_DIR has changed since the last build.
execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE_DIR}
                OUTPUT_VARIABLE describe OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_git)
if(no_git)
    set(describe "unknown")
endif()

file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#include "experiments/build_facts.h"

#include "pathtracer/integrator_hash.h"

namespace plumb {

const BuildFacts& build_facts() {
    static const BuildFacts facts{"@VERSION@", "@describe@", "@COMPILER@", "@BUILD_TYPE@", integrator_hash()};
    return facts;
}

}  // namespace plumb
]] @ONLY)
