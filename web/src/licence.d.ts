// SPDX-License-Identifier: Apache-2.0
// Licences are bundled as text (build.mjs).
declare module "*/LICENSE" {
  const text: string;
  export default text;
}
