# Run by samples/run.sh in this folder.
"$make_set" drapes --out .
