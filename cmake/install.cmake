# cmake --install: the program, the libraries with their headers below include/talkgraph, the CMake package, and the
# pipelines with their schemas as shared data, with the point schemes.
include(CMakePackageConfigHelpers)

set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/talkgraph)
set(LIBRARIES talkgraph_options talkgraph_plugin talkgraph_graph talkgraph_runtime talkgraph_nodes ${FAMILIES})
foreach(LIBRARY ${LIBRARIES})
  string(REPLACE talkgraph_ "" NAME ${LIBRARY})
  set_target_properties(${LIBRARY} PROPERTIES EXPORT_NAME ${NAME})
endforeach()
# OpenBLAS is linked from a folder of its own; libtalkgraph_codecs.so is loaded from ours, by users' programs as well.
set(CODECS_DIR ${CMAKE_INSTALL_LIBDIR}/talkgraph)
file(RELATIVE_PATH TO_CODECS /${CMAKE_INSTALL_BINDIR} /${CODECS_DIR})
set_target_properties(talkgraph PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON INSTALL_RPATH "$ORIGIN/${TO_CODECS}")
target_link_options(talkgraph_types INTERFACE $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CODECS_DIR}>)
install(TARGETS talkgraph_codecs LIBRARY DESTINATION ${CODECS_DIR})
install(TARGETS talkgraph ${LIBRARIES} EXPORT talkgraph)
install(EXPORT talkgraph NAMESPACE talkgraph:: FILE talkgraphTargets.cmake DESTINATION ${PACKAGE_DIR})

install(DIRECTORY graph runtime nodes DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/talkgraph FILES_MATCHING PATTERN "*.h")
install(DIRECTORY pipelines schemes DESTINATION ${CMAKE_INSTALL_DATADIR}/talkgraph)

configure_package_config_file(cmake/talkgraphConfig.cmake.in ${PROJECT_BINARY_DIR}/talkgraphConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/talkgraphConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/talkgraphConfig.cmake ${PROJECT_BINARY_DIR}/talkgraphConfigVersion.cmake
        DESTINATION ${PACKAGE_DIR})
