# The care of the sources.

.PHONY: format format-check rooms rooms-figure lint tidy cppcheck analyze
C_FILES  = $(shell find include src tests bench examples -name '*.[ch]' -o -name '*.cpp')
LINTED   = $(SOURCES) $(RUN) $(wildcard examples/*.c bench/*.c tests/*.c tests/fuzz/*.c bench/scene_files/*.c)

format: ## clang-format over all sources, in place
	clang-format -i $(C_FILES)

format-check: ## fails where clang-format would change something
	clang-format --dry-run -Werror $(C_FILES)

rooms: ## fails where a file of src/ includes from a room below its own; prints who includes whom
	@sh tests/rooms.sh
rooms-figure: ## draws docs/figures/rooms.svg anew
	@sh tests/rooms.sh draw

# Each fails on a finding. What is switched off stands with its reason in .clang-tidy (and those of
# bench/ and tests/), in .cppcheck, and below.
lint: tidy cppcheck analyze ## clang-tidy, cppcheck and gcc -fanalyzer over all sources

LINT_CFLAGS = $(STANDARD) -Iinclude -Isrc -Iexamples/ilsa_run $(BLAS_CFLAGS) $(FFT_CFLAGS)

tidy: $(LINTED:%=tidy/%) ## clang-tidy alone
.PHONY: $(LINTED:%=tidy/%)
$(LINTED:%=tidy/%): tidy/%:
	$(call say,TIDY,$*)
	$(Q)clang-tidy --quiet $* -- $(LINT_CFLAGS) 2>/dev/null

cppcheck: ## cppcheck alone
	$(call say,CPPCHECK)
	$(Q)cppcheck --quiet --std=c11 --enable=warning,style,performance,portability --inline-suppr \
	    --suppressions-list=.cppcheck --error-exitcode=1 -Iinclude -Isrc $(LINTED)

# malloc-leak: gcc 12 loses what is stored behind a pointer that a function was handed, which is how
# handles are filled; LeakSanitizer, valgrind and tests/test_memory.c look for leaks instead.
# The others, in tests: assertions of cmocka leave by longjmp, which gcc does not follow, so that a
# pointer may be NULL for it after assert_non_null.
ANALYZE       = -fanalyzer -Werror -Wno-analyzer-malloc-leak
ANALYZE_TESTS = $(addprefix -Wno-analyzer-,possible-null-dereference possible-null-argument \
                null-dereference null-argument use-of-uninitialized-value)

analyze: $(LINTED:%=analyze/%) ## gcc -fanalyzer alone
.PHONY: $(LINTED:%=analyze/%)
$(LINTED:%=analyze/%): analyze/%:
	$(call say,GCC,$*)
	$(Q)gcc $(LINT_CFLAGS) -O2 $(ANALYZE) $(if $(filter tests/%,$*),$(ANALYZE_TESTS)) -c -o /dev/null $*
