# cmake -D BUILD=... -D EXAMPLES=... -D CXX=... -D LAUNCHER=... -P install.cmake
set(PREFIX ${CMAKE_CURRENT_BINARY_DIR}/prefix)
set(PROJECT ${CMAKE_CURRENT_BINARY_DIR}/project)
file(REMOVE_RECURSE ${PREFIX} ${PROJECT})

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE SAID ERROR_VARIABLE SAID RESULT_VARIABLE CODE)
  if(CODE)
    message(FATAL_ERROR "${ARGN}:\n${SAID}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} --strip)
foreach(FILE bin/talkgraph include/talkgraph/graph/plugin.h share/talkgraph/pipelines/demo.json
             share/talkgraph/pipelines/talkgraph.schema.json share/talkgraph/schemes/ibug68.json)
  if(NOT EXISTS ${PREFIX}/${FILE})
    message(FATAL_ERROR "${FILE} is not installed")
  endif()
endforeach()
run(${PREFIX}/bin/talkgraph check ${PREFIX}/share/talkgraph/pipelines/demo.json)

# A copy, lest anything beside the examples be found.
file(COPY ${EXAMPLES}/ DESTINATION ${PROJECT})
run(${CMAKE_COMMAND} -G Ninja -S ${PROJECT} -B ${PROJECT}/build -D CMAKE_PREFIX_PATH=${PREFIX}
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${PROJECT}/build)
file(STRINGS ${PROJECT}/build/build.ninja LEAKED REGEX "-Werror|-fpch-preprocess|-include ")
if(LEAKED)
  message(FATAL_ERROR "talkgraph's own options reach those who use it: ${LEAKED}")
endif()
run(${CMAKE_CTEST_COMMAND} --test-dir ${PROJECT}/build --no-tests=error --output-on-failure)
