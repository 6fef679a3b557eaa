# cmake -DOUTPUT=<file.cpp> -DHEADER=<its header> -DTEXTS=<function=file,function=file...> -P EmbedText.cmake
# Writes each file as a function of namespace chiaro that returns its text, so that no program looks for it at run time.
string(REPLACE "," ";" texts "${TEXTS}")
set(code "#include \"${HEADER}\"\n\nnamespace chiaro {\n")
foreach(entry IN LISTS texts)
  string(FIND "${entry}" "=" at)
  string(SUBSTRING "${entry}" 0 ${at} name)
  math(EXPR at "${at} + 1")
  string(SUBSTRING "${entry}" ${at} -1 file)
  file(READ "${file}" text)
  string(APPEND code "\nstd::string_view ${name}() { return R\"CHIARO(${text})CHIARO\"; }\n")
endforeach()
file(WRITE "${OUTPUT}" "${code}\n}  // namespace chiaro\n")
