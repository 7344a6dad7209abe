# Run by samples/run.sh in this folder.
"$make_set" chair --out .
"$make_garments" sitter.bvh --kind skirt --length 0.56 --flare 0.2 --rings 36 --segments 90 --out skirt.obj
