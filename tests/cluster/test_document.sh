#!/bin/sh
# docs/cluster.md tells the truth: the commands of its sh blocks run, on two hosts of the names it uses, in a scratch folder that
# has the sheet and the tree's tests.
. "${srcdir:-.}/tests/support/tap.sh"

document=$srcdir/docs/cluster.md
commands() { awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$document"; }
here() { (cd "$scratch/home" && limited sh -c "$1"); }

why=$("$srcdir/tests/cluster/hosts.sh" 2 true 2>&1 < /dev/null) || { test $? = 77 && skip_all "$why"; }
mkdir -p "$scratch/home"
ln -s "$srcdir/tests" "$scratch/home"
sed 's/nx: [0-9]*/nx: 40/; s/ny: [0-9]*/ny: 40/; s/^name: .*/&\ngrain: 200/' "$srcdir/cloth/scenes/sheet.yaml" > "$scratch/home/sheet.yaml"
PATH=$(dirname "$DUITE_CLOTH"):$PATH
export PATH

plan_later
commands > "$scratch/commands"
ok "there are commands" test -s "$scratch/commands"
while IFS= read -r command; do
    case $command in
        srun* | sbatch* | salloc*) skip "$command" "needs Slurm: test_slurm.sh" ;;
        tests/cluster/hosts.sh*) ok "$command" here "$command" ;;
        *) ok "$command" here "tests/cluster/hosts.sh 2 env $command" ;;
    esac
done < "$scratch/commands"
