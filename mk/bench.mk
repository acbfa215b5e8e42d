# Programs that measure and draw.

.PHONY: benches bench accuracy speed extremes field figures paper-figures
benches: $(BENCH_PROGRAMS) ## builds all of bench/

bench: $(BENCH_PROGRAMS) ## the quick programs of bench/
	@set -e; for b in $(BENCH_QUICK); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

accuracy: $(BENCH_ACCURACY:%=$(BIN)/bench_%) ## the tables of bench/accuracy*.c
	@set -e; for b in $(BENCH_ACCURACY); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

speed: $(BENCH_SPEED:%=$(BIN)/bench_%) ## the tables of docs/speed.md, in a quarter of an hour
	@set -e; for b in $(BENCH_SPEED); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

extremes: $(BIN)/bench_extremes ## the table of docs/extremes.md, in three minutes
	$<

LEVEL = 3
field: $(BIN)/bench_field ## a hundred field scenes at LEVEL=3, judged: minutes
	$< -l $(LEVEL) $(wildcard tests/data/field/*.ini)

figures: ## the figures of every scene that was run into out/
	@set -e; for h in $(wildcard out/*/history.csv); do examples/figures.sh $${h%/history.csv}; done

# Section 5.2: a scene is run again when it or ilsa-run has changed.
PAPER = $(foreach g,symmetric asymmetric drop,$(foreach phi,1e-4 1e-2 1,$(g)_phi$(phi)))
out/paper/%/history.csv: examples/scenes/%.ini $(BIN)/ilsa-run
	$(BIN)/ilsa-run $< --quiet --out $(@D)

paper-figures: $(PAPER:%=out/paper/%/history.csv) ## Figs. 8 to 20 of the paper, in out/paper
	examples/paper_figures.sh out/paper
