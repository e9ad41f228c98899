// The lighting model of ScratchedNodeMaterial: what is added up of each light, and how scratches and base weaken one another.
import { InstancedInterleavedBuffer, InterleavedBufferAttribute, PhysicalLightingModel, Vector2 } from 'three/webgpu';
import {
  Break, If, Loop, anisotropy, anisotropyT, buffer, cameraProjectionMatrix, cameraWorldMatrix, clearcoat, clearcoatNormalView, dFdx, dFdy,
  diffuseContribution, float, instanceIndex, instancedBufferAttribute, lightTargetDirection, lightViewPosition, mat3, mat4,
  materialClearcoatRoughness, materialEnvIntensity, materialRoughness, metalness, mix, modelViewMatrix, normalView, normalViewGeometry, pmremTexture,
  positionGeometry, positionView, specularColorBlended, specularF90, uint, uniform, varying, vec2, vec3, vec4, viewportSize, viewportUV,
} from 'three/tsl';
import {
  bandCell, bandOf, brushedBase, environmentOnBody, fresnelOf, gratingCell, gratingSends, gratingShare, gratingTaken, maskOf, roundBase, scratchesSend, viewFromSurface,
} from './three_functions.js';
import { EnvironmentNodes } from './environment.js';
import { dielectricCurve } from './metals.js';
import { hasOutline, isFar } from './three_lights.js';
import { outlineNodes } from './three_outlines.js';
import { groovesAt } from './three_grooves.js';

/** The sun's, as a light's `userData.angle`. */
const SUN_RAD = 0.00465;
/** How far a light in the sky stands off. */
const FAR_M = 1000;
/** More scratches of one pixel do not mirror the environment. */
const SCRATCHES_MAX = 4096;
/** Look-ups of the environment along the band of a scratch and of a grating, ENVIRONMENT_CELLS and ROW_CELLS of band_environment.wgsl. */
const SCRATCH_CELLS = 10;
const ROW_CELLS = 48;
/** Variance of the filter of a pixel, in pixels. */
const FILTER_VARIANCE = 0.25;

/** Whether vertices move by themselves: in their pose of rest scratches are looked up. */
export const isBent = ({ isSkinnedMesh, isBatchedMesh, morphTargetInfluences }) => Boolean(isSkinnedMesh || isBatchedMesh || morphTargetInfluences?.length > 0);

/** Rows: how a triangle lies, from how a position changes over the picture. */
function triangleAxes(position) {
  const unit = (v) => v.mul(v.dot(v).max(1e-30).inverseSqrt()).toVar();
  const x = unit(dFdx(position));
  const z = unit(dFdx(position).cross(dFdy(position)));
  return [x, z.cross(x).toVar(), z];
}

/** From the object's frame to the view's, without the move: of a mesh, of each instance, or of each triangle of what bends. */
function viewFromObject(object, metresPerUnit) {
  if (isBent(object)) {
    const [from, to] = [positionGeometry, positionView].map(triangleAxes);
    return mat3(...to).mul(mat3(...from).transpose()).mul(metresPerUnit);
  }
  if (!object.isInstancedMesh) return mat3(modelViewMatrix);
  const { instanceMatrix } = object;
  const count = Math.max(instanceMatrix.count, 1);
  let matrix;
  if (count <= 1000) {
    matrix = buffer(instanceMatrix.array, 'mat4', count).element(instanceIndex);
  } else {
    const columns = new InstancedInterleavedBuffer(instanceMatrix.array, 16, 1);
    matrix = mat4(...[0, 4, 8, 12].map((offset) => instancedBufferAttribute(new InterleavedBufferAttribute(columns, 4, offset))));
  }
  const whole = modelViewMatrix.mul(matrix).toVar();
  return mat3(...[0, 1, 2].map((i) => varying(whole.element(i).xyz)));
}

/** Refractive index of every clear coat, and its reflectance at normal incidence. */
const COAT_IOR = 1.5;
const COAT_F0 = 0.04;

/** Variance of the slopes that a normal map gives a pixel, beside those of the smooth normals. */
function slopeVariance(normal) {
  const bent = normal.sub(normalViewGeometry);
  const [x, y] = [dFdx(bent), dFdy(bent)];
  return x.dot(x).add(y.dot(y)).mul(0.5 * FILTER_VARIANCE);
}

export class ScratchedLightingModel extends PhysicalLightingModel {
  /** `environment` is a texture, which three.js's maps are made of, and `maps` Hairline's, where there are such. */
  constructor(material, environment, maps) {
    super(material.useClearcoat, material.useSheen, material.useIridescence, material.useAnisotropy, material.useTransmission, material.useDispersion);
    this.material = material;
    this.environment = environment;
    this.maps = maps;
  }

  start(builder) {
    const { material } = this;
    const nodes = material.nodes();
    const side = normalViewGeometry.dot(normalView).sign();
    const perspective = vec2(cameraProjectionMatrix.element(0).x, cameraProjectionMatrix.element(1).y).toVar();
    const middle = cameraProjectionMatrix.element(2).xy;
    const place = {
      position: positionGeometry,
      view_from_object: viewFromObject(builder.object, nodes.metresPerUnit).toVar(),
      position_view: positionView,
      normal_view: normalView,
      pixel: vec3(vec2(2).div(viewportSize.mul(perspective)), cameraProjectionMatrix.element(3).w).toVar(),
      ray_view: viewportUV.mul(vec2(2, -2)).add(vec2(-1, 1)).add(middle).div(perspective).toVar(),
      move_x: dFdx(positionView).toVar(),
      move_y: dFdy(positionView).toVar(),
      turn_x: dFdx(normalViewGeometry).mul(side).toVar(),
      turn_y: dFdy(normalViewGeometry).mul(side).toVar(),
    };
    const { shapes, albedo, curves } = nodes;
    const baseOf = (own, { roughness, f0, f90, mixed, curve, hasMap }) => ({
      ...own, surface: vec4(f0, roughness).toVar(), more: vec3(curve, f90, hasMap ? slopeVariance(own.normal_view) : 0).toVar(), mixed,
      shapes, albedo, curves,
    });
    this.base = baseOf(place, {
      roughness: material.roughnessNode ? float(material.roughnessNode) : materialRoughness, f0: specularColorBlended, f90: specularF90,
      mixed: vec4(diffuseContribution, metalness).toVar(), curve: nodes.curve, hasMap: material.normalMap !== null || material.normalNode !== null,
    });
    this.functions = roundBase;
    if (this.anisotropy) {
      this.functions = brushedBase;
      this.base.facets = vec4(anisotropyT, anisotropy).toVar();
    }
    // Scratches lie in the coat, where there is one.
    let top = place;
    if (this.clearcoat) {
      top = { ...place, normal_view: clearcoatNormalView };
      this.coat = baseOf(top, {
        roughness: material.clearcoatRoughnessNode ? float(material.clearcoatRoughnessNode) : materialClearcoatRoughness, f0: vec3(COAT_F0), f90: 1,
        mixed: vec4(0), curve: dielectricCurve(COAT_IOR), hasMap: material.clearcoatNormalMap !== null || material.clearcoatNormalNode !== null,
      });
      this.coatSpecular = vec3(0).toVar();
    }
    this.scratches = material.scratches ? { ...top, tree: nodes.tree, tables: nodes.table } : null;
    const gratings = material.gratings.map((grating, i) => ({ rows: nodes.gratings[i].rows, ...groovesAt(grating, nodes.gratings[i].field, top, builder.geometry) }));
    const share = ({ rows: _, ...grooves }) => gratingShare({ ...top, ...grooves });
    const covered = gratings.length > 1 ? gratings.map(share).reduce((a, b) => a.add(b)).toVar() : float(1);
    this.gratings = gratings.map((grating) => ({ ...top, ...grating, covered }));
    this.specular = vec3(0).toVar();
    this.diffuse = vec3(0).toVar();
    this.scratchLight = vec3(0).toVar();
    this.gratingLight = vec3(0).toVar();

    this.around = this.maps && new EnvironmentNodes(this.maps);
    if (this.around) this.sunsOfEnvironment();

    super.start(builder);

    const { directDiffuse, directSpecular, indirectDiffuse, indirectSpecular } = builder.context.reflectedLight;
    directSpecular.addAssign(this.functions.reflected({ ...this.base, specular: this.specular }));
    directDiffuse.addAssign(this.diffuse.mul(diffuseContribution).mul(this.functions.body(this.base)));
    // What shines through the coat is no more reflected at the surface, and scratches take nothing of it.
    let through = null;
    if (this.coat) {
      const bare = clearcoat.oneMinus().toVar();
      const passed = roundBase.body(this.coat).mul(clearcoat).toVar();
      through = directSpecular.add(indirectSpecular).mul(passed).toVar();
      for (const light of [directDiffuse, indirectDiffuse]) light.mulAssign(passed.add(bare));
      directSpecular.assign(directSpecular.mul(bare).add(roundBase.reflected({ ...this.coat, specular: this.coatSpecular }).mul(clearcoat)));
      indirectSpecular.assign(indirectSpecular.mul(bare).add(this.clearcoatSpecularIndirect.mul(clearcoat)));
    }
    if (this.scratches || this.gratings.length > 0) {
      const axes = this.environment && !this.maps && viewFromSurface(top).toVar();
      const { normal_view } = top;
      const { facets: _, ...base } = this.base;
      let reflectance = fresnelOf({ ...base, normal_view });
      if (this.coat) reflectance = mix(reflectance, fresnelOf(this.coat), clearcoat);
      const left = vec3(1).toVar();
      const sent = vec3(0).toVar();
      for (const grating of this.gratings) {
        left.subAssign(gratingTaken(grating));
        if (axes) this.gratingLight.addAssign(this.aroundByCells(axes, ROW_CELLS, (j) => gratingCell({ ...grating, j })));
        if (this.around) this.gratingLight.addAssign(this.byMaps(gratingSends, grating));
      }
      sent.addAssign(this.gratingLight);
      if (this.scratches) {
        // Scratches lie on top.
        const mask = maskOf(this.scratches).toVar();
        const beside = mask.xyz.oneMinus().toVar();
        if (axes) this.scratchLight.addAssign(this.scratchesByEnvironment(axes));
        if (this.around) this.scratchLight.addAssign(this.byMaps(scratchesSend, this.scratches));
        left.mulAssign(beside);
        sent.assign(sent.mul(beside).add(this.scratchLight.mul(mask.w)));
      }
      directSpecular.assign(directSpecular.mul(left).add(sent.mul(reflectance)));
      indirectSpecular.mulAssign(left);
    }
    if (through) directSpecular.addAssign(through);
  }

  /** The suns that were parted from an environment. */
  sunsOfEnvironment() {
    for (const [radiance, shape, byShape] of this.around.suns) this.light(radiance, [shape, byShape], [shape, byShape]);
  }

  byMaps(functions, lit) {
    return functions.byEnvironment({ ...lit, ...this.around.maps }).mul(this.around.factor);
  }

  indirectDiffuse(builder) {
    super.indirectDiffuse(builder);
    if (!this.around) return;
    const { surface, more, mixed, shapes, albedo, curves, facets, ...place } = this.base;
    const mean = environmentOnBody({ ...place, ...this.around.maps }).mul(this.around.factor);
    builder.context.reflectedLight.indirectDiffuse.addAssign(mean.mul(diffuseContribution).mul(this.functions.body(this.base)));
  }

  indirectSpecular(builder) {
    super.indirectSpecular(builder);
    if (!this.around) return;
    const reflected = (functions, base) => {
      const specular = functions.byEnvironment({ ...base, ...this.around.maps }).mul(this.around.factor);
      return functions.reflected({ ...base, specular });
    };
    builder.context.reflectedLight.indirectSpecular.addAssign(reflected(this.functions, this.base));
    if (this.coat) this.clearcoatSpecularIndirect.addAssign(reflected(roundBase, this.coat));
  }

  finish(builder) {
    // start() has laid the coat on.
    const { clearcoat: had } = this;
    this.clearcoat = false;
    super.finish(builder);
    this.clearcoat = had;
  }

  direct({ lightDirection, lightColor, lightNode }) {
    const { light } = lightNode;
    let center;
    let radius;
    let radiance;
    if (isFar(light)) {
      center = positionView.add(lightDirection.mul(FAR_M));
      radius = uniform(0).onRenderUpdate(() => FAR_M * Math.sin(light.userData.angle ?? SUN_RAD));
      radiance = lightColor.mul(FAR_M * FAR_M);
    } else {
      center = lightViewPosition(light);
      radius = uniform(0).onObjectUpdate(({ material }) => light.userData.radius ?? material.lightRadius);
      const way = center.sub(positionView);
      // three.js holds its fall-off at that of 0.1 m.
      radiance = lightColor.mul(way.dot(way).max(0.01));
      if (lightNode.constructor.type === 'SpotLightNode') {
        // The rim is that of glTF and Hairline, t^2 in the place of three's t^2 (3 - 2 t).
        const { coneCosNode, penumbraCosNode } = lightNode;
        const cosine = lightDirection.dot(lightTargetDirection(light));
        const t = cosine.sub(coneCosNode).div(penumbraCosNode.sub(coneCosNode)).clamp();
        radiance = radiance.div(float(3).sub(t.mul(2)));
      }
    }
    const sphere = { light: vec4(center, radius).toVar() };
    this.light(radiance.div(radius.mul(radius).mul(Math.PI)).toVar(), [sphere, 'bySphere'], [sphere, 'bySphere']);
  }

  directRectArea({ lightColor, lightNode, lightPosition, halfWidth, halfHeight }) {
    const { light } = lightNode;
    let radiance = lightColor;
    if (light.userData.angle !== undefined) {
      const away = positionView.sub(lightPosition).normalize();
      const ahead = halfHeight.cross(halfWidth).normalize();
      const rim = uniform(new Vector2()).onRenderUpdate((_, self) => {
        const { angle, penumbra = 0 } = light.userData;
        return self.value.set(Math.cos(angle), Math.cos(angle * (1 - penumbra)));
      });
      radiance = radiance.mul(away.dot(ahead).sub(rim.x).div(rim.y.sub(rim.x).max(1e-6)).clamp().pow2());
    }
    radiance = radiance.toVar();
    // The light shines to its own -z.
    const quad = { middle: lightPosition.toVar(), half_width: halfHeight.toVar(), half_height: halfWidth.toVar() };
    if (hasOutline(light)) this.light(radiance, [outlineNodes(light), 'byOutline'], [outlineNodes(light), 'byOutline']);
    else if (this.anisotropy) this.light(radiance, [outlineNodes(light), 'byOutline'], [quad, 'byQuad']);
    else this.light(radiance, [quad, 'byQuad'], [quad, 'byQuad']);
  }

  /** Adds a light: to the base, then to grooves, by functions of a name, each with its own view of the light. */
  light(radiance, [shape, byShape], [onGrooves, byGrooves]) {
    const lit = this.functions[byShape]({ ...this.base, ...shape }).toVar();
    this.specular.addAssign(radiance.mul(lit.xyz));
    this.diffuse.addAssign(radiance.mul(lit.w));
    if (this.coat) this.coatSpecular.addAssign(radiance.mul(roundBase[byShape]({ ...this.coat, ...shape }).xyz));
    if (this.scratches) this.scratchLight.addAssign(radiance.mul(scratchesSend[byGrooves]({ ...this.scratches, ...onGrooves })));
    for (const grating of this.gratings) this.gratingLight.addAssign(radiance.mul(gratingSends[byGrooves]({ ...grating, ...onGrooves })));
  }

  scratchesByEnvironment(axes) {
    const { tables } = this.scratches;
    const sum = vec3(0).toVar();
    const band = mat4(vec4(0), vec4(0), vec4(0), vec4(0)).toVar();
    Loop({ start: uint(0), end: uint(SCRATCHES_MAX), type: 'uint', condition: '<', name: 'scratch' }, () => {
      band.assign(bandOf({ ...this.scratches, walked: band }));
      If(band.element(3).y.equal(0), () => Break());
      If(band.element(0).z.greaterThan(0), () => {
        sum.addAssign(this.aroundByCells(axes, SCRATCH_CELLS, (j) => bandCell({ band, tables, j })));
      });
    });
    return sum;
  }

  /** Light of the environment along a band, cell by cell. */
  aroundByCells(axes, cells, cellOf) {
    const sum = vec3(0).toVar();
    Loop({ start: uint(0), end: uint(cells), type: 'uint', condition: '<', name: 'cell' }, ({ cell }) => {
      const found = cellOf(cell).toVar();
      const direction = axes.mul(found.element(0).xyz).transformDirection(cameraWorldMatrix);
      const radiance = pmremTexture(this.environment, direction, found.element(0).w).mul(materialEnvIntensity);
      sum.addAssign(radiance.mul(found.element(1).xyz));
    });
    return sum;
  }
}
