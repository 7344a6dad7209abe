# Run by samples/run.sh in this folder.
"$make_set" swing --out .
"$make_garments" child.bvh --kind skirt --length 0.37 --flare 0.2 --rings 32 --segments 90 --out skirt.obj
