# The map engine beside OctoMap and OpenVDB; run it without arguments for the whole table.
if(STEREOVOX_OPENVDB_LIBRARIES)
  set(openvdb_peer map_engine_openvdb.cpp)
else()
  set(openvdb_peer map_engine_without_openvdb.cpp)
endif()
add_executable(map_engine
  map_engine.cpp map_engine_measure.cpp map_engine_world.cpp ${openvdb_peer})
target_link_libraries(map_engine PRIVATE
  stereovox::occupancy stereovox_build_options fmt::fmt CLI11::CLI11 ${OCTOMAP_LIBRARIES}
  ${STEREOVOX_OPENVDB_LIBRARIES})
target_include_directories(map_engine SYSTEM PRIVATE ${OCTOMAP_INCLUDE_DIRS})
