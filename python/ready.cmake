# For pip: the module of a build folder (PLIANT_PYTHON_BUILD) in place of one that is built anew. ./dev wheel and the tests use it.
file(GLOB ready ${PLIANT_PYTHON_BUILD}/python/pliant/_core*.so)
if(NOT ready)
  message(FATAL_ERROR "PLIANT_PYTHON_BUILD: ${PLIANT_PYTHON_BUILD}/python holds no package pliant: that build has left it out")
endif()
add_custom_target(pliant_python)  # what pip asks for
install(FILES ${ready} DESTINATION pliant COMPONENT python)
