// Linked into programs with a sanitizer alone. GL drivers are unloaded when their display ends; what they leak could not be told by its
// module any more (leaks_of_others.supp), and would be reported as ours.
extern "C" int dlclose(void*) { return 0; }
