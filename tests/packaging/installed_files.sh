#!/usr/bin/env bash
# installed_files.sh PREFIX MANIFEST: checks that all files for users have been installed, and no file that only
# developers need.
set -euo pipefail
prefix=$1 manifest=$2
failures=0
fail() { printf '%s\n' "$*" >&2; failures=1; }
installed() { grep -Eq -- "^$prefix/$1\$" "$manifest" || fail "not installed: $1"; }

commands=$("$prefix/bin/pkmopt" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p')
(($(wc -w <<< "$commands") > 15)) || fail "few commands: $commands"
for command in $commands; do installed "share/man/man1/pkmopt-$command\.1\.gz"; done
for file in bin/pkmopt bin/pkmopt-check-proof 'lib[^/]*(/.*)?/libpkmopt_'{core,mechanisms,optimisers,io,program}'\.a' \
  'lib[^/]*(/.*)?/cmake/pkmopt/pkmopt-config\.cmake' 'lib[^/]*(/.*)?/libpkmopt\.so'{,.0} include/pkmopt.h \
  share/pkmopt/matlab/{pkmopt_mex.c,'\+pkmopt/'{build,Design}.m,'\+pkmopt/\+internal/toml.m',loadlibrary/{pkmopt_prototypes.h,example.m}} \
  lib/python3/dist-packages/pkmopt/{__init__,mechanism,study}.py 'lib[^/]*(/.*)?/pkgconfig/pkmopt\.pc' include/pkmopt/engine/mechanism/mechanism.hpp \
  include/pkmopt/experiments/app/program.hpp share/man/man1/pkmopt{,-check-proof}\\.1\\.gz share/bash-completion/completions/pkmopt \
  share/zsh/vendor-completions/_pkmopt share/fish/vendor_completions.d/pkmopt.fish \
  share/doc/pkmopt/{README.md,CHANGELOG.md,changelog.gz,LICENSE,docs/install.md,docs/tutorials/cluster.md,licences/libhdf5-dev} \
  share/pkmopt/experiments/{4ppa-2par/paper-problem.toml,mechanisms/linear-delta.toml,slurm/study.sbatch}; do
  installed "$file"
done
for script in "$prefix"/share/pkmopt/experiments/{3crr-r-cru/{force-curves,coupling-maps},2t1r-p-hybrid/motion-curves}.sh; do
  [[ -x $script ]] || fail "missing or not executable: $script"
done
# Headers: the public ones and those that they include, but not the implementation.
headers=$(grep 'hpp$' "$prefix/include/pkmopt/public_headers.txt")
(($(wc -w <<< "$headers") > 20)) || fail "few public headers: $headers"
for header in $headers; do installed "include/pkmopt/$header"; done
! grep -E '/include/pkmopt/(engine/(generic|accelerators|storage|runner|report)/|objectives|constraints)' "$manifest" ||
  fail "installed, but no public header includes it"
! grep -E '\.(cpp|in|h5)$|CMakeLists|/(debian-packages|package|quickstart)\.sh$|experiments/app/[^p]' "$manifest" ||
  fail "installed, but for developers only"

# The targets of the links in README.md: pages, studies and pictures.
cd -- "$prefix/share/doc/pkmopt"
links=$(grep -oE '(\]\(|src=")(docs|experiments)/[^)#"]*\.(md|toml|svg|png)' README.md | sed 's/^.*[("]//')
(($(wc -l <<< "$links") > 5)) || fail "few links in README.md: $links"
for link in $links; do [[ -e $link ]] || fail "broken link in README.md: $link"; done
exit $failures
