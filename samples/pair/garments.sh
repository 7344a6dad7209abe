# Run by samples/run.sh in this folder.
"$make_garments" ../../../shared/assets/characters/ozz_pab_fbx/skeleton.fbx --kind skirt --flare 0.2 --out skirt.obj
