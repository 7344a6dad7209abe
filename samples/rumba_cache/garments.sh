# Run by samples/run.sh in this folder. The first frame is the pose that the skirt is made for.
"$make_garments" ../../../shared/assets/garments/cipc_mannequin_rumba/body_frame0_yup.obj --kind skirt --out skirt.obj
