# Runs 06_graph.json by talkgraph with the plugin and looks at what comes of it:
#   cmake -D TALKGRAPH=... -D PLUGIN=... -D GRAPH=... -P check_plugin.cmake
foreach(ORDER "--plugin;${PLUGIN};run;${GRAPH}" "run;${GRAPH};--plugin;${PLUGIN}")
  execute_process(COMMAND ${TALKGRAPH} ${ORDER} -o plugin_run --overwrite --no-cache --quiet COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(READ plugin_run/scores.json SCORES)
string(JSON CORRELATION GET "${SCORES}" rows all acc)
if(CORRELATION LESS 0.99)
  message(FATAL_ERROR "the jaw does not follow: correlation ${CORRELATION}")
endif()

execute_process(COMMAND ${TALKGRAPH} check ${GRAPH} RESULT_VARIABLE CODE ERROR_VARIABLE SAID)
if(NOT CODE EQUAL 2 OR NOT SAID MATCHES "mine.babble")
  message(FATAL_ERROR "without the plugin its nodes are not known, but: ${CODE} ${SAID}")
endif()
execute_process(COMMAND ${TALKGRAPH} nodes --plugin nowhere.so RESULT_VARIABLE CODE ERROR_VARIABLE SAID)
if(NOT CODE EQUAL 2 OR NOT SAID MATCHES "plugin nowhere.so: there is no such file")
  message(FATAL_ERROR "a plugin that is missing must be an error, but: ${CODE} ${SAID}")
endif()
